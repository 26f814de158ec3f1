#pragma once
// The state of a run as a value. README.md (State) says how a class lists its fields, once, and which it does not list;
// saving, loading and comparing follow from the list. A class that must do or check something after loading has `void
// loaded()`, which throws std::invalid_argument if its fields contradict each other.
//
// Numbers are stored exactly, little-endian: integers in 8 bytes, floating point unchanged, other scalar types by a
// list of their own or a specialisation of SavedNumber. The length comes before lists, maps and texts, the index before
// an alternative of a variant. `To` has put(const void*, size_t); `From` has get(void*, size_t), which throws at its
// end, and left(), the number of bytes left.

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "cradle/core/base/fields.hpp"
#include "cradle/core/base/require.hpp"

namespace cradle {

static_assert(std::endian::native == std::endian::little);

// How a scalar type that is not built in is stored: `save(To&, const X&)` and `load(From&, X&)`.
template <class X> struct SavedNumber;

template <class X>
concept ListsState = requires(X& x) {
  X::state(x);
};

namespace detail {

template <class X, template <class...> class Of> inline constexpr bool is = false;
template <class... A, template <class...> class Of> inline constexpr bool is<Of<A...>, Of> = true;
template <class X> inline constexpr bool is_sequence = is<X, std::vector> || is<X, std::deque>;
template <class X> inline constexpr bool is_map = is<X, std::map> || is<X, std::unordered_map>;
// Lists that are stored as one block of memory.
template <class X> inline constexpr bool is_plain = std::same_as<X, std::string>;
template <class A> inline constexpr bool is_plain<std::vector<double, A>> = true;
template <class A> inline constexpr bool is_plain<std::vector<std::uint64_t, A>> = true;

template <class X> inline constexpr bool is_whole = std::is_integral_v<X> || std::is_enum_v<X>;

// The size of a floating-point number without its padding.
template <std::floating_point X>
inline constexpr std::size_t bytes_of = std::numeric_limits<X>::digits == 64 ? 10 : sizeof(X);

// The least number of bytes of a value, which limits how many of them a file can contain.
template <class X> constexpr std::size_t least_bytes() {
  if constexpr (is_whole<X>) {
    return 8;
  } else if constexpr (std::floating_point<X>) {
    return bytes_of<X>;
  } else if constexpr (is<X, std::pair>) {
    return least_bytes<typename X::first_type>() + least_bytes<typename X::second_type>();
  } else if constexpr (is_plain<X> || is_sequence<X> || is_map<X> || is<X, std::optional> || is<X, std::variant>) {
    return 8;
  } else if constexpr (ListsState<X>) {
    return []<class With, class... F>(std::type_identity<Fields<With, F...>>) {
      return (std::size_t{1} + ... + least_bytes<F>()) - (sizeof...(F) > 0 ? 1 : 0);
    }(std::type_identity<decltype(X::state(std::declval<X&>()))>{});
  } else {
    return 1;
  }
}

[[noreturn, gnu::cold, gnu::noinline]] inline void refuse_number(const char* what, std::uint64_t number) {
  throw std::invalid_argument(std::string(what) + " (" + std::to_string(number) + "): take the file from a copy");
}
// Reads the number of entries; each has at least so many bytes.
template <class From> std::size_t length(From& from, std::size_t least) {
  std::uint64_t number = 0;
  from.get(&number, sizeof number);
  if (number > from.left() / least) refuse_number("a list longer than what holds it, in entries", number);
  return number;
}

}  // namespace detail

template <class To, class X> void save(To& to, const X& x) {
  if constexpr (detail::is_whole<X>) {
    const auto number = static_cast<std::uint64_t>(x);
    to.put(&number, sizeof number);
  } else if constexpr (std::floating_point<X>) {
    to.put(&x, detail::bytes_of<X>);
  } else if constexpr (detail::is_plain<X>) {
    save(to, x.size());
    to.put(x.data(), x.size() * sizeof x[0]);
  } else if constexpr (detail::is_sequence<X>) {
    save(to, x.size());
    for (const auto& each : x) save(to, each);
  } else if constexpr (detail::is_map<X>) {
    const std::map<typename X::key_type, typename X::mapped_type> in_order(x.begin(), x.end());
    save(to, in_order.size());
    for (const auto& [key, value] : in_order) save(to, key), save(to, value);
  } else if constexpr (detail::is<X, std::optional>) {
    save(to, x.has_value());
    if (x) save(to, *x);
  } else if constexpr (detail::is<X, std::pair>) {
    save(to, x.first), save(to, x.second);
  } else if constexpr (detail::is<X, std::variant>) {
    save(to, x.index());
    std::visit([&](const auto& value) { save(to, value); }, x);
  } else if constexpr (ListsState<X>) {
    X::state(x)([&](const auto&... field) { (save(to, field), ...); });
  } else {
    SavedNumber<X>::save(to, x);
  }
}

// Throws std::invalid_argument if the bytes cannot be those of such a value; passes on what `from` throws at its end.
template <class From, class X> void load(From& from, X& x) {
  if constexpr (detail::is_whole<X>) {
    std::uint64_t number = 0;
    from.get(&number, sizeof number);
    x = static_cast<X>(number);
    if (static_cast<std::uint64_t>(x) != number) detail::refuse_number("a number out of range", number);
  } else if constexpr (std::floating_point<X>) {
    from.get(&x, detail::bytes_of<X>);
  } else if constexpr (detail::is_plain<X>) {
    x.resize(detail::length(from, sizeof x[0]));
    if (!x.empty()) from.get(x.data(), x.size() * sizeof x[0]);
  } else if constexpr (detail::is_sequence<X>) {
    x.resize(detail::length(from, detail::least_bytes<typename X::value_type>()));
    for (auto& each : x) load(from, each);
  } else if constexpr (detail::is_map<X>) {
    x.clear();
    for (auto left = detail::length(from, detail::least_bytes<typename X::key_type>()); left > 0; --left) {
      typename X::key_type key{};
      load(from, key);
      load(from, x[key]);
    }
  } else if constexpr (detail::is<X, std::optional>) {
    bool there = false;
    load(from, there);
    if (!there) return x.reset();
    if constexpr (std::default_initializable<typename X::value_type>) {
      if (!x) x.emplace();
    }
    if (!x) throw std::invalid_argument("a state of something else: take the file from a copy");
    load(from, *x);
  } else if constexpr (detail::is<X, std::pair>) {
    load(from, x.first), load(from, x.second);
  } else if constexpr (detail::is<X, std::variant>) {
    std::uint64_t number = 0;
    load(from, number);
    if (number >= std::variant_size_v<X>) detail::refuse_number("of a kind that is not known", number);
    [&]<std::size_t... K>(std::index_sequence<K...>) {
      ((number == K ? load(from, x.template emplace<K>()) : void()), ...);
    }
    (std::make_index_sequence<std::variant_size_v<X>>{});
  } else if constexpr (ListsState<X>) {
    X::state(x)([&](auto&... field) { (load(from, field), ...); });
    if constexpr (requires { x.loaded(); }) x.loaded();
  } else {
    SavedNumber<X>::load(from, x);
  }
}

// A state in memory. Two values are equal if their bytes are.
class SavedState {
 public:
  SavedState() = default;
  explicit SavedState(std::string bytes) : bytes_(std::move(bytes)) {}
  template <class X> static SavedState of(const X& x) {
    SavedState state;
    save(state, x);
    return state;
  }
  const std::string& bytes() const& { return bytes_; }
  std::string bytes() && { return std::move(bytes_); }
  bool operator==(const SavedState& other) const { return bytes_ == other.bytes_; }

  void put(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  void get(void* data, std::size_t size) {
    if (size > left()) throw std::invalid_argument("the state ends too early: take the file from a copy");
    std::memcpy(data, bytes_.data() + read_, size);
    read_ += size;
  }
  std::uint64_t left() const { return bytes_.size() - read_; }

 private:
  std::string bytes_;
  std::size_t read_ = 0;
};

// The shape of a class's state, as text: the kinds of its fields. States with the same shape cannot be distinguished.
template <class X> void append_shape(std::string& shape);
template <class... X> void append_shapes(std::string& shape, const char* open, const char* close) {
  shape += open;
  (append_shape<X>(shape), ...);
  shape += close;
}
template <class X> void append_shape(std::string& shape) {
  if constexpr (detail::is_whole<X>) {
    shape += 'i';
  } else if constexpr (std::floating_point<X>) {
    shape += 'f' + std::to_string(detail::bytes_of<X>);
  } else if constexpr (std::same_as<X, std::string>) {
    shape += 's';
  } else if constexpr (detail::is_sequence<X>) {
    append_shapes<typename X::value_type>(shape, "[", "]");
  } else if constexpr (detail::is_map<X>) {
    append_shapes<typename X::key_type, typename X::mapped_type>(shape, "{", "}");
  } else if constexpr (detail::is<X, std::optional>) {
    append_shapes<typename X::value_type>(shape, "?", "");
  } else if constexpr (detail::is<X, std::pair>) {
    append_shapes<typename X::first_type, typename X::second_type>(shape, "", "");
  } else if constexpr (detail::is<X, std::variant>) {
    [&]<class... A>(std::type_identity<std::variant<A...>>) {
      append_shapes<A...>(shape, "<", ">");
    }(std::type_identity<X>{});
  } else if constexpr (ListsState<X>) {
    [&]<class With, class... F>(std::type_identity<Fields<With, F...>>) {
      append_shapes<F...>(shape, "(", ")");
    }(std::type_identity<decltype(X::state(std::declval<X&>()))>{});
  } else {
    shape += 'n';
  }
}
template <class X> std::string state_shape() {
  std::string shape;
  append_shape<X>(shape);
  return shape;
}

// For `loaded`: throws if fields contradict each other.
inline void require_state(bool holds, const char* what) {
  require(holds, "a state that cannot be (", what, "): take the file from a copy");
}

// States that are too large for memory are saved to and loaded from these streams of bytes, which have a buffer. What
// is behind the buffer, a file with its checksum for instance, is the business of who derives from them.
class StateSink {
 public:
  void put(const void* data, std::size_t size) {
    if (buffer_.size() + size > buffer_size) flush();
    buffer_.append(static_cast<const char*>(data), size);
  }

 protected:
  static constexpr std::size_t buffer_size = std::size_t{1} << 18;

  ~StateSink() = default;
  /// Passes the buffer on and empties it.
  virtual void flush() = 0;

  std::string buffer_;
};

class StateSource {
 public:
  void get(void* data, std::size_t size) {
    if (size > buffer_.size() - at_) return get_slowly(static_cast<char*>(data), size);
    std::memcpy(data, buffer_.data() + at_, size);
    at_ += size;
  }
  /// The number of bytes not read yet.
  std::uint64_t left() const { return after_buffer_ + (buffer_.size() - at_); }
  /// Throws if bytes are left: then the source has something else.
  virtual void end() const = 0;

 protected:
  ~StateSource() = default;
  /// Reads what the buffer does not have as a whole. Throws if the source ends before.
  virtual void get_slowly(char* data, std::size_t size) = 0;

  std::string buffer_;
  std::size_t at_ = 0;              // position in the buffer
  std::uint64_t after_buffer_ = 0;  // bytes of the state after the buffer
};

}  // namespace cradle
