#pragma once
// The walls of a run in its proof: what their collisions make of the lines of particles, and their accounts. Without
// gravity lines meet walls as they meet each other. With it, in the frame that falls (world_lines.hpp), walls are
// parabolas: the time of a collision follows from a square root (certain_wall.hpp), and the new line starts there. If
// they meet at T, at the speed u away from the wall (A, V) afterwards, and t is the double next to T, then with d = T -
// t
//
//   velocity = V + u - a T,   place at t = A + V t - a t^2/2 - u d + a d^2/2   (left wall; the right one: -u).
//
// A particle that comes straight from a wall is known better from there: it left it at the time T, at its place, with
// the speed u. To the same floor it comes back at T + 2 u/p with exactly this speed, so the times of a bouncing ball
// are known up to the rounding of their sums, where its line alone would lose a digit with every second bounce.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "cradle/core/certify/certain_state.hpp"
#include "cradle/core/certify/certain_wall.hpp"
#include "cradle/core/certify/world_lines.hpp"

namespace cradle {

template <Enclosing N> class CertainWalls {
 public:
  using Line = WorldLine<N>;

  explicit CertainWalls(const Particles<N>& particles) {
    for (const End end : {End::left, End::right})
      if (const Wall<N>* wall = particles.wall(end)) walls_[number_of(end)].emplace(*wall, end);
    pulled_ = any() && particles.fall();
  }

  bool any() const { return walls_[0] || walls_[1]; }
  // Whether there are gaps to walls that gravity opens or closes.
  bool pulled() const { return pulled_; }
  const CertainAccounts<N>& accounts() const { return accounts_; }
  const Sizes& sizes() const { return sizes_; }  // only what walls add to them

  // Without gravity, of a collision that is known to be later than the last one of the particle.
  [[gnu::noinline]] std::optional<Doubt<N>> strike(Motion<N>& motion, const LastMeeting<N>& meeting,
                                                   const typename Motion<N>::Places& places, const N& after) {
    const End end = motion.lines.is_wall(meeting.l) ? End::left : End::right;
    const bool left = end == End::left;
    const ParticleIndex struck = left ? meeting.r : meeting.l;
    Line& line = motion.lines[struck];
    const N mass = motion.lines.mass(struck), &wall_place = left ? places.left : places.right,
            &wall_velocity = motion.lines[left ? meeting.l : meeting.r].velocity;
    N place = left ? places.right : places.left;
    CertainAccount<N>& account = accounts_[number_of(end)];
    const double given = to_double(account.given);
    if (!(*walls_[number_of(end)])({place, line.velocity, wall_place, wall_velocity, meeting.closing, after}, mass,
                                   account))
      return uncertain_mass(mass);
    line.place = place;
    line.changed = motion.of_collisions ? N::widened(places.time, after.size()) : meeting.time;
    line.touched = true;
    add_sizes(to_double(line.velocity), to_double(wall_velocity), to_double(account.given) - given);
    return std::nullopt;
  }

  // With gravity: when a particle meets a wall, and how fast.
  struct Approaching {
    ParticleIndex wall, struck;
    N time{0}, closing{0};
  };
  std::optional<Doubt<N>> approach(const Motion<N>& motion, Approaching& at) const {
    const auto [from, start] = approach_of(motion, at.wall, at.struck);
    const N square = from.square();
    if (!is_positive(square)) return Doubt<N>{Check::reaches, is_negative(square), -1, -1, N(0), square};
    const auto meeting = from.meeting(square);
    at.time = start + meeting.in, at.closing = meeting.speed;
    return std::nullopt;
  }
  bool reflects(ParticleIndex wall) const { return !walls_[number_of(end_of(wall))]->thermal(); }
  // Makes that collision, known to be later than the particle's last one. `elastic`: whatever the wall's restitution.
  std::optional<Doubt<N>> strike(Motion<N>& motion, const Approaching& at, bool elastic) {
    const End end = end_of(at.wall);
    const CertainWall<N>& wall = *walls_[number_of(end)];
    CertainAccount<N>& account = accounts_[number_of(end)];
    Line& line = motion.lines[at.struck];
    const Line& of_wall = motion.lines[at.wall];
    const N mass = motion.lines.mass(at.struck);
    const std::optional<N> speed = wall.speed_after(at.closing, mass, elastic, account);
    if (!speed) return uncertain_mass(mass);
    const double given = to_double(account.given);
    wall.enter(at.closing, *speed, mass, of_wall.velocity, elastic, account);
    const N after = wall.away(*speed), near = N(at.time.middle(), 0), off = at.time - near;
    line.place = of_wall.place + of_wall.velocity * near - motion.fallen(near) - after * off + motion.fallen(off);
    line.velocity = of_wall.velocity + after - motion.acceleration * at.time;
    line.changed = at.time;
    line.touched = true;
    departures_.insert_or_assign(at.struck, Departure{at.wall, at.time, *speed});
    add_sizes(to_double(of_wall.velocity + after), to_double(of_wall.velocity), to_double(account.given) - given);
    return std::nullopt;
  }

  // With gravity: checks that a particle beside a ceiling did not meet it since its last collision, until a time when
  // it meets something else, which may be the other wall.
  [[gnu::noinline]] std::optional<Doubt<N>> stays_open(const Motion<N>& motion, ParticleIndex particle, const N& until,
                                                       std::optional<ParticleIndex> met = {}) const {
    const ParticleIndex ceiling = is_positive(motion.acceleration) ? -1 : motion.lines.count();
    if (!motion.lines.holds(ceiling) || met == ceiling || particle != (ceiling < 0 ? 0 : ceiling - 1)) return {};
    const auto from_wall = departures_.find(particle);
    if (from_wall != departures_.end() && from_wall->second.wall == ceiling) return {};  // it falls away
    const auto [from, start] = approach_of(motion, ceiling, particle);
    const Line& line = motion.lines[particle];
    const auto open = from.closes((line.touched ? line.changed : motion.zero) - start, until - start);
    if (!open) return {};
    return Doubt<N>{Check::turns, open->refuted, std::min(ceiling, particle), std::max(ceiling, particle),
                    open->first,  open->second};
  }
  // Two particles have met: what is known of where they come from holds no longer, but where they exchange their lines.
  [[gnu::noinline]] void met(ParticleIndex l, ParticleIndex r, bool exchange) {
    auto of_l = departures_.extract(l), of_r = departures_.extract(r);
    if (!exchange) return;
    if (!of_l.empty()) of_l.key() = r, departures_.insert(std::move(of_l));
    if (!of_r.empty()) of_r.key() = l, departures_.insert(std::move(of_r));
  }

 private:
  // Where a particle comes from, if it had no collision since but exchanges.
  struct Departure {
    ParticleIndex wall;
    N time, speed;
  };
  struct Start {
    CertainApproach<N> approach;
    N time;
  };

  // From the time when the particle left a wall, else from the origin of its line.
  Start approach_of(const Motion<N>& motion, ParticleIndex wall, ParticleIndex struck) const {
    const Line &line = motion.lines[struck], &of_wall = motion.lines[wall];
    const bool left = wall < 0;
    const auto towards = [left](const N& x) { return left ? -x : x; };
    const N pull = towards(motion.acceleration);
    const auto from_wall = departures_.find(struck);
    if (from_wall == departures_.end()) {
      const N time = motion.origin(line);
      return {{towards(of_wall.place + of_wall.velocity * time - (line.place + motion.fallen(time))),
               towards(line.velocity + motion.acceleration * time - of_wall.velocity), pull},
              time};
    }
    const Departure& left_at = from_wall->second;
    if (left_at.wall == wall) return {{N(0), -left_at.speed, pull}, left_at.time};
    const Line& other = motion.lines[left_at.wall];
    const N apart = of_wall.velocity - other.velocity;
    return {{towards(of_wall.place - other.place + apart * left_at.time), left_at.speed - towards(apart), pull},
            left_at.time};
  }
  static Doubt<N> uncertain_mass(const N& mass) { return {Check::side, false, -1, -1, mass, N(to_double(mass))}; }
  void add_sizes(double speed, double of_wall, double given) {
    sizes_.wall_speed = std::max({sizes_.wall_speed, std::abs(speed), std::abs(of_wall)});
    sizes_.wall_energy += std::max(0., given);
  }
  static End end_of(ParticleIndex wall) { return wall < 0 ? End::left : End::right; }
  static std::size_t number_of(End end) { return static_cast<std::size_t>(end); }

  std::array<std::optional<CertainWall<N>>, 2> walls_;
  bool pulled_ = false;
  CertainAccounts<N> accounts_;
  Sizes sizes_;
  std::unordered_map<ParticleIndex, Departure> departures_;
};

}  // namespace cradle
