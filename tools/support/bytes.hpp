// Numbers and text as bytes, for journals and messages between ranks: float64, uint64 and UTF-8, little-endian, lengths
// before contents. What is read must be what was written; it comes checksummed, so a reader that runs out of bytes has
// met another version's.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cradle/tools/support/errors.hpp"

namespace cradle::tools {

static_assert(std::endian::native == std::endian::little);

template <class T>
concept Number = std::same_as<T, double> || std::same_as<T, std::uint64_t>;

class ByteWriter {
 public:
  ByteWriter& reserve(std::size_t bytes) {
    bytes_.reserve(bytes);
    return *this;
  }
  template <Number T> ByteWriter& put(T number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
    return *this;
  }
  ByteWriter& put(std::string_view text) {
    put(std::uint64_t{text.size()});
    bytes_.append(text);
    return *this;
  }
  template <Number T> ByteWriter& put(const std::vector<T>& numbers) {
    put(std::uint64_t{numbers.size()});
    bytes_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
    return *this;
  }
  ByteWriter& put(const std::vector<std::string>& texts) {
    put(std::uint64_t{texts.size()});
    for (const std::string& text : texts) put(text);
    return *this;
  }
  const std::string& bytes() const& { return bytes_; }
  std::string bytes() && { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <Number T> T number() {
    T value{};
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::uint64_t integer() { return number<std::uint64_t>(); }
  std::string text() { return std::string(take(integer())); }
  template <Number T> std::vector<T> numbers() {
    const std::uint64_t size = integer();
    if (size > bytes_.size() / sizeof(T)) take(bytes_.size() + 1);
    std::vector<T> values(size);
    const std::string_view bytes = take(size * sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  std::vector<std::string> texts() {
    std::vector<std::string> texts;
    for (std::uint64_t left = integer(); left > 0; --left) texts.push_back(text());
    return texts;
  }
  bool empty() const { return bytes_.empty(); }

 private:
  std::string_view take(std::uint64_t size) {
    if (size > bytes_.size())
      throw Error({}, "a record ends too early", "another version's?", "use the program that wrote it", Exit::io);
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  std::string_view bytes_;
};

}  // namespace cradle::tools
