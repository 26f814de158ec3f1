#pragma once
// Numbers with enclosures (precision/ball.hpp) as the checker needs them: the operations of a Real, whose results
// enclose all that operands may be, comparisons that are certain, combinations that do not widen what they combine.

#include <concepts>

#include "cradle/core/base/real.hpp"

namespace cradle {

enum class Order { less, greater, open };

template <class N>
concept Enclosing = Real<N> && requires(const N x, const N y, const typename N::Share c) {
  // In plain doubles if these decide it; else in the numbers themselves, open where they overlap.
  { order_in_doubles(x, y) } -> std::same_as<Order>;
  { order_in_balls(x, y) } -> std::same_as<Order>;
  typename N::Share;
  N(1.5);  // doubles are exact
  // The number in its middle, how far it may be from that, and the same with more room.
  N(x.middle(), 0);
  { N::widened(x, x.radius()) } -> std::same_as<N>;
  // Bounds on its size.
  { x.size() } -> std::same_as<decltype(x.radius())>;
  { x.least_size() } -> std::same_as<decltype(x.radius())>;
  // (1 - c) x + c y and (1 - d) y + d x, given x - y, with shares c and d: numbers, or functions of x - y.
  requires std::constructible_from<typename N::Share, const N&>;
  requires std::constructible_from<typename N::Share, const N&, const N&>;
  { N::combined(x, y, x, c, c).left } -> std::convertible_to<N>;
  { N::combined(x, y, x, c, c).right } -> std::convertible_to<N>;
};

}  // namespace cradle
