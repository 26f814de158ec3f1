#pragma once
// Walls at the ends of a line: particles of infinite mass with a constant speed, or shaken about a place that has it
// (wall_motion.hpp). The left one counts as particle -1, the right one as particle N, and the gap to a wall is a gap
// like any other. A collision with a wall, closing at the speed w > 0, obeys the wall's own law, in the frame of the
// wall:
//
//   reflecting   w' = -r w, r the restitution of the wall
//   thermal      w' = -v, v from the density (m v/T) exp(-m v^2/2T) of speeds at which particles of mass m in
//                equilibrium at the temperature T come from the wall, whatever w was
//
// Random speeds are keyed by seed, replica, wall and number of the collision at this wall, so they do not depend on the
// order of collisions elsewhere. They are doubles in every scalar type, so that all types have the same walls.
//
// Every wall has an account of what it gives to the particles: momentum, and the energy m (w - w') V if it moves at V
// towards them, to which a thermal wall adds m/2 (w'^2 - w^2), the heat that leaves it. A reflecting wall dissipates
// m/2 (1 - r^2) w^2. The ledger of losses has the sum: what is dissipated minus what is given.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "cradle/core/base/counter_rng.hpp"
#include "cradle/core/base/state.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/laws/wall_motion.hpp"

namespace cradle {

enum class End : std::uint8_t { left, right };

template <Real T> struct Wall {
  T position;              // at the start
  T speed{0};              // positive to the right
  T restitution{1};        // of a reflecting wall, in [0, 1]
  double temperature = 0;  // of a thermal wall, > 0
  std::uint64_t seed = 1, replica = 0;
  std::shared_ptr<const WallMotion<T>> motion = nullptr;  // of a shaken wall
  T rest_speed{0};  // particles that meet it more slowly stay on it while it presses them, under gravity or if shaken

  bool reflects() const { return !(temperature > 0); }
  bool holds() const { return is_positive(rest_speed) && reflects(); }
  bool moves() const { return !(speed == T(0)) || motion != nullptr; }
  T fastest() const { return magnitude(speed) + (motion != nullptr ? motion->fastest() : T(0)); }
};

// The account of a wall: its collisions, the energy (m l^2/t^2) and the momentum (m l/t, positive to the right) that it
// has given to the particles (negative: taken), and the energy dissipated in its collisions.
template <Real T> struct WallTally {
  std::uint64_t collisions = 0;
  CompensatedSum<T> given, momentum, dissipated;
  static auto state(auto& self) { return fields(self.collisions, self.given, self.momentum, self.dissipated); }
  void loaded() const {
    for (const auto* sum : {&given, &momentum, &dissipated})
      require_state(is_finite(sum->sum) && is_finite(sum->errors), "walls");
  }
};
// Of the left wall and of the right one, in the order of End.
template <Real T> using WallTallies = std::array<WallTally<T>, 2>;
// Energy that walls have given to the particles.
template <Real T> T given_by(const WallTallies<T>& walls) { return walls[0].given.value() + walls[1].given.value(); }

// The speed after collision number k of a particle of mass 1 with a wall of temperature 1.
inline double thermal_speed(std::uint64_t seed, std::uint64_t replica, End end, std::uint64_t collision) {
  // Indices that no particle has: displacements and velocities use those up to about 2^62 (counter_rng.hpp, gas.hpp).
  const std::uint64_t bits =
      random_bits(seed, replica, collision | (std::uint64_t{end == End::left ? 0xFEU : 0xFFU} << 56));
  return std::sqrt(2 * exponential(bits));
}

// The walls of a line of particles: none, one or two.
template <Real T> class Walls {
 public:
  Walls() = default;
  // `left`, `right` may be null; otherwise they must outlive this. `particles`: the number of particles between them.
  Walls(const Wall<T>* left, const Wall<T>* right, std::int64_t particles)
      : walls_{left, right}, last_(particles - 1) {}

  bool any() const { return has(End::left) || has(End::right); }
  const Wall<T>& wall(std::int64_t gap) const { return *walls_[at(left_of(gap) ? End::left : End::right)]; }
  bool has(End end) const { return walls_[at(end)] != nullptr; }
  // Whether there is a wall at this end of the gap right of a particle. (Copies of parts of a ring number particles
  // beyond its ends.)
  bool left_of(std::int64_t gap) const { return gap < 0 && has(End::left); }
  bool right_of(std::int64_t gap) const { return gap == last_ && has(End::right); }
  bool beside(std::int64_t gap) const { return left_of(gap) || right_of(gap); }

  // The collision of a particle of this mass with the wall at the gap, with closing speed w > 0.
  Outcome<T> strike(std::int64_t gap, const T& w, const T& mass) { return strike(gap, w, mass, wall(gap).restitution); }
  // The same with another restitution than that of the wall, if it reflects, and at the speed towards the particles
  // at which it is shaken.
  Outcome<T> strike(std::int64_t gap, const T& w, const T& mass, const T& restitution, const T& shaken = T(0)) {
    const End end = left_of(gap) ? End::left : End::right;
    const Wall<T>& wall = *walls_[at(end)];
    WallTally<T>& tally = tallies_[at(end)];
    // Of impulse and final speed, the larger one is computed from the other, see law.hpp.
    const T half = (T(1) + restitution) * w / T(2);
    const bool hard = !(wall.temperature > 0) && !(restitution * T(2) < T(1));
    const T after = hard ? T(w - (half + half)) : T(-outgoing(wall, end, w, mass, restitution, tally.collisions));
    const T handed = hard ? T(half + half) : T(w - after);
    const T in_its_frame =
        wall.temperature > 0 ? T((w - after) * (w + after)) : T((T(1) - restitution) * (T(1) + restitution) * w * w);
    const T work = mass * handed * ((end == End::left ? wall.speed : T(-wall.speed)) + shaken);
    const T lost = mass * in_its_frame / T(2) - work;
    tally.collisions += 1;
    tally.momentum.add(mass * (end == End::left ? handed : T(-handed)));
    tally.given.add(wall.temperature > 0 ? T(-lost) : work);
    if (!(wall.temperature > 0)) tally.dissipated.add(mass * in_its_frame / T(2));
    return {after, end == End::left ? T(0) : handed, end == End::left ? handed : T(0), lost};
  }

  // The outcome at the speed 1 if outcomes are proportional to the speed; no such collision is made in the run.
  std::optional<Outcome<T>> at_unit_speed(std::int64_t gap, const T& mass) const {
    if (!wall(gap).reflects()) return {};
    return Walls(*this).strike(gap, T(1), mass);
  }
  bool give_energy() const {
    for (const auto* wall : walls_)
      if (wall != nullptr && (wall->temperature > 0 || wall->moves())) return true;
    return false;
  }

  // Enters what a wall has given to a particle that it holds.
  void carry(End end, const T& energy, const T& momentum) {
    tallies_[at(end)].given.add(energy);
    tallies_[at(end)].momentum.add(momentum);
  }
  const WallTally<T>& tally(End end) const { return tallies_[at(end)]; }
  const WallTallies<T>& tallies() const { return tallies_; }
  void continue_with(const WallTally<T>& left, const WallTally<T>& right) { tallies_ = {left, right}; }

  static auto state(auto& self) { return fields(self.tallies_[0], self.tallies_[1]); }

 private:
  static std::size_t at(End end) { return static_cast<std::size_t>(end); }
  static T outgoing(const Wall<T>& wall, End end, const T& w, const T& mass, const T& restitution,
                    std::uint64_t collision) {
    if (!(wall.temperature > 0)) return restitution * w;
    return exactly<T>(thermal_speed(wall.seed, wall.replica, end, collision) *
                      std::sqrt(wall.temperature / to_double(mass)));
  }

  std::array<const Wall<T>*, 2> walls_{};
  WallTallies<T> tallies_;
  std::int64_t last_ = 0;
};

}  // namespace cradle
