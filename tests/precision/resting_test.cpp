// Particles that come to rest on one another on a floor, in every kind of scalar type, against a simulation of its own
// in 100 digits: positions and velocities, the gap to the floor followed in small steps. At rest, uniformly moving and
// shaken floors, with different masses.
#include <gtest/gtest.h>

#include <boost/math/constants/constants.hpp>
#include <optional>
#include <vector>

#include "cradle/core/initial/walled.hpp"
#include "cradle/tests/core/fixtures.hpp"
#include "cradle/tests/precision/every_scalar.hpp"

namespace cradle::test::resting_in_types_test {

using Reference = bin_float;

// The numbers of a scene, exact in every type; shape: nothing for a floor that is not shaken.
struct Setup {
  const char* name;
  std::optional<Shape> shape;
  double amplitude = 0.25, speed = 0, restitution = 0.75, of_floor = 0.25, rest_speed = 0.125;
};
const Setup setups[] = {
    {"at rest", {}},
    {"uniform", {}, 0, 0.25},
    {"sine that holds", Shape::sine, 0.0625},  // A omega^2 = 0.56 < g = 1
    {"sine", Shape::sine},
    {"moving sine", Shape::sine, 0.25, -0.125},
    {"parabola", Shape::parabola},
    {"nearly elastic", Shape::sine, 0.25, 0, 0.875, 0.75, 0.25},
};
const Reference touching("1e-40"), small("1e-50");  // gaps that count as 0; displacements at collisions
constexpr double frequency = 3, until = 10;
const std::vector<double> places{0.5, 1.125, 1.75, 6, 30}, velocities{0, -0.25, 0.5, 0, 0.25},
    masses{1, 1.5, 0.5, 2, 1};

// ---- the simulation in 100 digits
struct Brute {
  const Setup& setup;
  Reference displaced;  // at each event all free ones are, in turn to either side
  Reference t{0}, pi = boost::math::constants::pi<Reference>();
  std::vector<Reference> x = numbers<Reference>(places), v = numbers<Reference>(velocities);  // of free ones
  std::size_t resting = 0;
  struct Event {
    Reference time;
    int left;
  };
  std::vector<Event> events{};

  Reference turns(const Reference& at) const {
    const Reference y = frequency * at / (2 * pi);
    return y - floor(y + Reference(0.5));
  }
  Reference place(const Reference& at) const {
    const Reference y = turns(at), uniform = setup.speed * at;
    if (!setup.shape) return uniform;
    if (*setup.shape == Shape::sine) return uniform + setup.amplitude * sin(frequency * at);
    return uniform + 16 * setup.amplitude * y * (Reference(0.5) - abs(y));
  }
  Reference speed(const Reference& at) const {
    if (!setup.shape) return setup.speed;
    if (*setup.shape == Shape::sine) return setup.speed + setup.amplitude * frequency * cos(frequency * at);
    return setup.speed + 4 * setup.amplitude * frequency / pi * (1 - 4 * abs(turns(at)));
  }
  Reference strongest() const {
    return setup.amplitude * frequency * frequency * (*setup.shape == Shape::sine ? Reference(1) : 8 / (pi * pi));
  }
  bool presses(const Reference& at) const {
    if (!setup.shape || strongest() < 1) return true;
    return *setup.shape == Shape::sine ? strongest() * sin(frequency * at) < 1 : turns(at) < 0;
  }
  // The time until what rests is let go: where the floor falls as fast as what is free.
  std::optional<Reference> let_go() const {
    if (resting == 0 || !setup.shape || strongest() < 1) return {};
    const Reference phase = *setup.shape == Shape::sine ? Reference(asin(1 / strongest()) / (2 * pi)) : Reference(0);
    const Reference wait = phase - turns(t);
    return (wait < 0 ? wait + 1 : wait) * 2 * pi / frequency;
  }
  Reference height(const Reference& wait) const {  // of the lowest free one above the floor
    return x[resting] + v[resting] * wait - wait * wait / 2 - place(t + wait);
  }
  std::optional<Reference> meeting(const Reference& within) const {
    if (speed(t) > v[resting] && height(0) < touching) return Reference(0);
    Reference before(0), step("1e-9");
    while (before < within) {
      Reference after = before + step;
      if (height(after) < 0) {
        for (int k = 0; k < 40; ++k) {
          const Reference middle = (before + after) / 2;
          (height(middle) < 0 ? after : before) = middle;
        }
        for (int k = 0; k < 6; ++k) after -= height(after) / (v[resting] - after - speed(t + after));
        return after;
      }
      before = after;
      if (step < 0.002) step *= 1.25;
    }
    return {};
  }
  void fly(const Reference& wait) {
    for (std::size_t i = resting; i < x.size(); ++i) {
      x[i] += v[i] * wait - wait * wait / 2 + ((events.size() + i) % 2 == 0 ? displaced : Reference(-displaced));
      v[i] -= wait;
    }
    t += wait;
  }
  // A collision of the lowest free one with what rests, or with the floor.
  void land() {
    const std::size_t i = resting;
    const Reference w = speed(t) - v[i];
    if (w < setup.rest_speed && presses(t)) {
      ++resting;
    } else if (i == 0) {
      x[0] = place(t), v[0] += w * (1 + setup.of_floor);
    } else {
      --resting;
      x[i - 1] = place(t), v[i - 1] = speed(t);
      x[i] = x[i - 1];
      collide(i - 1);
    }
  }
  void collide(std::size_t i) {
    const Reference w = v[i] - v[i + 1], impulse = (1 + setup.restitution) * w / (1 / masses[i] + 1 / masses[i + 1]);
    v[i] -= impulse / masses[i];
    v[i + 1] += impulse / masses[i + 1];
    x[i + 1] = x[i];
  }
  void run() {
    for (;;) {
      std::optional<Reference> first = let_go();
      int what = -2;
      if (!first || *first > until - t) first = until - t, what = -3;
      if (resting < x.size())
        if (const auto wait = meeting(*first)) first = wait, what = static_cast<int>(resting) - 1;
      for (std::size_t i = resting; i + 1 < x.size(); ++i) {
        const Reference w = v[i] - v[i + 1], gap = x[i + 1] - x[i], wait = gap < touching ? Reference(0) : gap / w;
        if (w > 0 && wait < *first) first = wait, what = static_cast<int>(i);
      }
      const auto lowest = static_cast<int>(resting) - 1;
      fly(*first);
      if (what == -3) return;
      if (what == -2) {
        for (; resting > 0; --resting) x[resting - 1] = place(t), v[resting - 1] = speed(t);
        continue;
      }
      events.push_back({t, what});
      what == lowest ? land() : collide(static_cast<std::size_t>(what));
    }
  }
};

template <class T> std::vector<Brute::Event> events_of(const Setup& setup) {
  Wall<T> floor{T(0), exactly<T>(setup.speed), exactly<T>(setup.of_floor)};
  floor.rest_speed = exactly<T>(setup.rest_speed);
  if (setup.shape)
    floor.motion =
        std::make_shared<WallMotion<T>>(*setup.shape, exactly<T>(setup.amplitude), exactly<T>(frequency), T(0));
  const Scene<T> particles = std::make_shared<Walled<T>>(
      list(numbers<T>(places), numbers<T>(velocities), numbers<T>(masses)), floor, std::nullopt, T(-1));
  auto run = mass_run(particles, Inelastic<T>(exactly<T>(setup.restitution)));
  std::vector<Brute::Event> events;
  EXPECT_EQ(run.advance(T(static_cast<int>(until)),
                        [&](const Collision<T>& c) {
                          events.push_back({Reference(to_double(c.time.value())), static_cast<int>(c.left)});
                        }),
            Status::reached);
  EXPECT_EQ(run.account().order_lost, 0U);
  return events;
}

template <class P> class SlowRestingIn : public InPrecision<P> {};
TYPED_TEST_SUITE(SlowRestingIn, EachKindOfPrecision, PrecisionName);

// The same collisions, at the same times: to what errors of 64 units of rounding of a length of 1, in double, in every
// collision make of them, which small displacements show.
TYPED_TEST(SlowRestingIn, ThePileHasTheCollisionsOfBruteForce) {
  using T = typename TypeParam::Scalar;
  for (const Setup& setup : setups) {
    SCOPED_TRACE(setup.name);
    Brute brute{setup, Reference(0)}, displaced{setup, small};
    brute.run(), displaced.run();
    const auto found = events_of<T>(setup);
    ASSERT_EQ(displaced.events.size(), brute.events.size());
    ASSERT_EQ(found.size(), brute.events.size());
    EXPECT_GT(found.size(), 12U);
    Reference growth(1);
    for (std::size_t k = 0; k < found.size(); ++k) {
      growth = std::max<Reference>(growth, abs(displaced.events[k].time - brute.events[k].time) / small);
      ASSERT_EQ(found[k].left, brute.events[k].left) << k;
      EXPECT_LE(abs(found[k].time - brute.events[k].time), 64 * 0x1p-52 * growth) << k;
    }
  }
}

}  // namespace cradle::test::resting_in_types_test
