#pragma once
// How a class lists the fields that are its state (README.md, State): static auto state(auto& self) { return
// fields(self.a, self.b); }

namespace cradle {

// The fields of an object, by reference: it passes them to what it is called with. (A tuple would do the same, but an
// engine has hundreds of such lists, and tuples took 4 to 14 % of the time to compile it.)
template <class With, class... F> struct Fields : With {};
template <class... F> auto fields(F&... field) {
  const auto with = [&field...](const auto& use) -> decltype(auto) { return use(field...); };
  return Fields<decltype(with), F...>{with};
}
// Those of a base, and then more.
template <class With, class... B, class... F> auto fields(const Fields<With, B...>& base, F&... field) {
  return base([&](auto&... each) { return fields(each..., field...); });
}

}  // namespace cradle
