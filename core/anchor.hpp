#pragma once
// Bodies whose flight is known, from which positions and velocities of the others are told: one that has not collided,
// or the one at an end of a line, which is followed from contact to contact.

#include <tuple>

#include "cradle/core/bodies.hpp"
#include "cradle/core/clock.hpp"

namespace cradle {

template <Real T> struct Flight {
  Pair<T> x, v;
  static auto state(auto& self) { return std::tie(self.x, self.v); }
};

// Of a body that has not collided, so long after the start.
template <Real T> Flight<T> undisturbed(const Bodies<T>& bodies, BodyIndex body, const T& elapsed) {
  const T v = bodies.velocity(body);
  return {two_sum(bodies.position(body), T(v * elapsed)), {v, T(0)}};
}

// Times are local ones of the chain whose clock is given.
template <Real T> class Anchor {
 public:
  BodyIndex body() const { return body_; }

  Flight<T> flight(const Bodies<T>& bodies, const Clock<T>& clock, const T& time) const {
    if (!collided_) return undisturbed(bodies, body_, clock.elapsed(time));
    return {from_.x + T(from_.v.value() * difference(Pair<T>{time, T(0)}, since_)), from_.v};
  }

  T velocity(const Bodies<T>& bodies) const { return collided_ ? from_.v.value() : bodies.velocity(body_); }

  // Goes over to a body that has not collided.
  void take(BodyIndex body) { body_ = body; }
  // Goes over to the last body of a line, which gains velocity in a contact now: Gain is T or Pair<T>.
  template <class Gain>
  void follow(BodyIndex body, const Bodies<T>& bodies, const Clock<T>& clock, const T& time, const Gain& gain) {
    body_ = body;
    from_ = flight(bodies, clock, time);
    from_.v = from_.v + gain;
    since_ = {time, T(0)};
    collided_ = true;
  }
  void move_origin(const T& by) { since_ = since_ - by; }
  static auto state(auto& self) { return std::tie(self.body_, self.collided_, self.from_, self.since_); }

 private:
  BodyIndex body_ = 0;
  bool collided_ = false;
  Flight<T> from_;  // once it has collided: as its last contact, at the time since_, left it
  Pair<T> since_;
};

}  // namespace cradle
