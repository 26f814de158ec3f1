#pragma once
// Particles between walls that are at rest, move, are hot or are shaken, with or without gravity; the runs made of
// them, and what holds in each.

#include "cradle/core/initial/walled.hpp"
#include "cradle/core/observe/configuration_statistics.hpp"
#include "cradle/core/observe/guards.hpp"
#include "cradle/core/observe/sample.hpp"
#include "cradle/tests/core/fixtures.hpp"

namespace cradle::test {

using Shaking = std::shared_ptr<const WallMotion<double>>;

template <class T>
Scene<T> between(const std::type_identity_t<T>& acceleration, const Scene<T>& particles,
                 std::type_identity_t<std::optional<Wall<T>>> left = {},
                 std::type_identity_t<std::optional<Wall<T>>> right = {}) {
  return std::make_shared<Walled<T>>(particles, std::move(left), std::move(right), acceleration);
}
inline Wall<double> thermal(double position, double temperature) {
  return {.position = position, .temperature = temperature, .seed = 5, .replica = 2};
}
inline Shaking shaken(Shape shape, double amplitude, double phase = 0, double frequency = 3) {
  return std::make_shared<WallMotion<double>>(shape, amplitude, frequency, phase);
}
inline Wall<double> wall(double position, Shaking motion, double restitution = 1, double speed = 0,
                         double rest_speed = 0) {
  return {.position = position,
          .speed = speed,
          .restitution = restitution,
          .motion = std::move(motion),
          .rest_speed = rest_speed};
}
inline constexpr Shape shapes[] = {Shape::sawtooth, Shape::parabola, Shape::sine};

// What is left of the energy beyond what walls gave and what was lost, at most over the sizes of these.
template <class Run> double unaccounted(const Run& run, const Particles<double>& particles, double t) {
  const auto now = sample(run, particles.kinetic_energy(), t);
  const double potential = potential_energy(run.configuration(t), particles, t);
  return std::abs(now.energy + potential - (particles.mechanical_energy() - now.energy_lost + now.given)) /
         (now.energy + std::abs(potential) + now.energy_lost + std::abs(now.given));
}
// `off`: an error planted in the energy of the ledger.
template <class Run> bool guards_hold(const Run& run, const Particles<double>& particles, double t, double off = 0) {
  return !guarded(run.configuration(t), particles, run.counts().collisions,
                  particles.mechanical_energy() - run.energy_lost(t) + off, t, run.last_collision_time(), 0., true)
              .broken;
}

}  // namespace cradle::test
