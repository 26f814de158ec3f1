#pragma once
// One of several laws, chosen when a run begins. Engines that are rarely used, or whose law takes a small part of the
// time, are compiled once for all these laws. The first law costs a branch that the processor predicts.

#include <concepts>
#include <cstddef>
#include <variant>

#include "cradle/core/laws/law.hpp"

namespace cradle {

template <class First, class... Others> class OneOf {
 public:
  static constexpr bool bounces_only = First::bounces_only;
  static_assert(((Others::bounces_only == bounces_only) && ...));

  template <class Law> OneOf(const Law& law) : law_(law) {}

  // f(law), the law by its own type.
  template <std::size_t K = 0, class F> [[gnu::always_inline]] auto visit(const F& f) const {
    const auto* law = std::get_if<K>(&law_);
    if constexpr (K < sizeof...(Others))
      if (law == nullptr) [[unlikely]]
        return visit<K + 1>(f);
    return f(*law);
  }

  template <class T, class Masses>
  [[gnu::always_inline]] Outcome<T> operator()(const T& w, const Masses& masses) const {
    return visit([&](const auto& law) { return law(w, masses); });
  }
  bool scale_free() const requires ScaleFreeLaw<First> {
    return visit([]<class Law>(const Law& law) {
      if constexpr (ScaleFreeLaw<Law>)
        return law.scale_free();
      else
        return false;
    });
  }
  // Null if it is another one.
  template <class Law> const Law* as() const { return std::get_if<Law>(&law_); }

 private:
  std::variant<First, Others...> law_;
};

template <class L>
concept LawChoice = requires(const L& law) {
  law.visit([](const auto&) {});
};

// f(law), a chosen law by its own type.
template <class L, class F> auto with_law(const L& law, const F& f) {
  if constexpr (LawChoice<L>)
    return law.visit(f);
  else
    return f(law);
}

// The law as one of a certain type; null if it is another one.
template <class Law, class L> const Law* law_as(const L& law) {
  if constexpr (std::same_as<Law, L>)
    return &law;
  else if constexpr (LawChoice<L>)
    return law.template as<Law>();
  else
    return nullptr;
}

template <LawChoice L> bool has_threshold(const L& law) {
  return law.visit([](const auto& own) { return has_threshold(own); });
}

// Whether it is a law with memory.
template <Real T, class L> bool has_memory(const L& law) {
  return with_law(law, []<class Own>(const Own&) { return LawWithMemory<Own, T>; });
}

}  // namespace cradle
