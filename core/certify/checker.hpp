#pragma once
// A proof that a run is right. Given the collisions of a run one by one, as pairs of neighbours, the checker computes
// the world lines of all particles from the scene's own decimals, every number enclosed (precision/ball.hpp), and
// checks what makes them the motion of the exact system. It shares no arithmetic with the engine that proposes the
// collisions.
//
// World lines. Particle k flies along x = a_k + v_k t, t since the start, until its next collision. Two particles l, r
// meet at T = (a_r - a_l)/w, w = v_l - v_r, and whatever impulse J they exchange,
//
//   (a, v)_l' = (a, v)_l - c_l ((a, v)_l - (a, v)_r),   (a, v)_r' = (a, v)_r + c_r ((a, v)_l - (a, v)_r),
//
// c_l = J/(m_l w), c_r = J/(m_r w): one linear map for places and velocities, since both lines go through the same
// point. The time T does not enter. For identical particles c = (1 + eps)/2: the matrix is doubly stochastic, radii are
// averaged and only roundings add to them. Merging is an average too.
//
// Checked at the start: every gap is certainly positive. At each collision of l and r:
//   1. they are neighbours;
//   2. w > 0 certainly;
//   3. T is certainly later than the last collision of either of them;
//   4. w is certainly on one side of every threshold of the law.
// At a time t to which the run is to be proved: every gap is certainly positive then, and the last collision of every
// particle certainly earlier.
//
// Theorem. If all of this holds, these world lines are the motion of the exact system up to t, it has made exactly
// these collisions, and every place and velocity lies in its ball.
//
// Proof. By 3 the collisions of each particle are in the order of their true times, so its world line is a continuous,
// piecewise linear function of time. Impulses push apart (J >= 0, with 2): a collision on the left of particle k makes
// it faster, one on its right slower. So between two collisions of a gap with itself, the place of the particle on its
// left is a convex function of time and that of the particle on its right a concave one, and the gap is concave. It is
// 0 at its own collisions and positive at the start and at t. A concave function that is 0 or positive at both ends of
// an interval is positive within, unless it is 0 throughout; and that it is not: after a collision it opens at the
// speed w' > 0. So no gap is ever negative, and each is 0 at its collisions alone: no collision is missing, none
// invented, each obeyed the law (2, 4). Three particles never meet at one time (3), so the motion is unique. Collisions
// that share no particle may come in any order. Particles that pass exchange their cells of the line: J <= mu w, so the
// left cell continues at v_r + J/m_r <= v_l and the right one at v_l - J/m_l >= v_r, slower and faster as after a
// bounce.
//
// Walls (certain_wall.hpp) have world lines as well, which nothing changes. Next to the left one, particle 0 is only
// hit on its right between two collisions with the wall: its place is concave and that of the wall linear, so the gap
// is concave and the argument holds. So it does at the right one.
//
// With a restitution of 0, w' = 0: particles stay together until one of them is hit, and the next collision fails 2.
// Particles that merge have no gap any more. Particles that pass change places, and their gap is one of cells in the
// order of the line, as it is in the engine. On a ring the argument holds for the images. Particles of a row that no
// collision has reached fly in order, by how they were placed (rows.hpp).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cradle/core/certify/certain_law.hpp"
#include "cradle/core/certify/certain_wall.hpp"
#include "cradle/core/certify/side_by_side.hpp"
#include "cradle/core/certify/world_lines.hpp"

namespace cradle {

enum class Check { neighbours, closing, later, side, gap, before, agreement };

// Where a proof ends: two quantities of which the first should be less, or on one side of the second.
template <Enclosing N> struct Doubt {
  Check check = Check::gap;
  bool refuted = false;  // it is certain that it is not so; else it is open
  ParticleIndex left = -1, right = -1;
  N first{0}, second{0};
};

// What bounds the rounding of a run's particles (agreement.hpp), in plain doubles.
struct Sizes {
  std::uint64_t particles = 0;
  double mass = 0, least_mass = 0, start_energy = 0, start_speed = 0, place = 0;  // speed, place: the largest
  // Of walls: the largest speed of one, or of a particle that comes from one, and the energy that they have given,
  // without what they have taken.
  double wall_speed = 0, wall_energy = 0;

  void add(double of_mass, double speed) {
    least_mass = particles++ == 0 ? of_mass : std::min(least_mass, of_mass);
    mass += of_mass;
    start_energy += of_mass * speed * speed / 2;
    start_speed = std::max(start_speed, std::abs(speed));
  }
};

// What is certain at a time.
template <Enclosing N> struct CertainState {
  std::optional<Doubt<N>> doubt;
  N energy{0};
  N time{0}, closing{0};  // at a collision: of it
  CertainAccounts<N> walls;
  bool over = true;                          // no neighbours approach each other: there is no collision any more
  std::optional<N> front_left, front_right;  // places of the outermost particles that have collided, on a line
  // In powers of ten: the largest radius of a place, the smallest gap, the largest radius of one against itself.
  double widest = nothing, least_gap = -nothing, widest_of_gap = nothing;
  static constexpr double nothing = -std::numeric_limits<double>::infinity();
  Sizes sizes;  // of the particles held
};

template <Enclosing N> class Checker {
 public:
  using Share = typename N::Share;
  using Line = WorldLine<N>;

  Checker(std::shared_ptr<const Particles<N>> particles, const CertainLaw<N>& law)
      : laws_(law), lines_(std::move(particles), !law.bounces_only()), length_(lines_.particles().circumference()),
        half_(N(1) / N(2)), of_collisions_(!law.linear()) {
    for (const End end : {End::left, End::right})
      if (const Wall<N>* wall = lines_.particles().wall(end)) walls_[number_of(end)].emplace(*wall, end);
    if constexpr (SideBySide<N>)
      if (law.bounces_only() && law.linear() && lines_.identical_masses() && !law.contact_time)
        bounces_.emplace(laws_.bouncing, law.cutoff ? *law.cutoff : N(-1), law.elastic);
  }

  // The particles at the start.
  std::optional<Doubt<N>> begin() const { return state_at(N(0)).doubt; }

  // The next collision of the run. Where it is in doubt, no world line is changed.
  std::optional<Doubt<N>> collision(ParticleIndex left, ParticleIndex right) {
    if (!are_neighbours(left, right)) return Doubt<N>{Check::neighbours, true, left, right};
    auto doubt = strike(lines_.cluster(left), lines_.cluster(right));
    if (doubt) doubt->left = left, doubt->right = right;
    return doubt;
  }

  // The next collisions of the run, as one after the other. Those before the one that is in doubt are proved; after it
  // nothing more can be checked.
  using Pair = std::pair<ParticleIndex, ParticleIndex>;
  struct DoubtAt {
    std::size_t number;  // of the collision
    Doubt<N> doubt;
  };
  std::optional<DoubtAt> collisions(std::span<const Pair> pairs) {
    if constexpr (SideBySide<N>) {
      for (std::size_t begin = 0; bounces_ && begin < pairs.size(); begin += most_at_once)
        if (auto doubt = side_by_side(pairs.subspan(begin, std::min(most_at_once, pairs.size() - begin)))) {
          doubt->number += begin;
          return doubt;
        }
      if (bounces_) return std::nullopt;
    }
    for (std::size_t k = 0; k < pairs.size(); ++k)
      if (auto doubt = collision(pairs[k].first, pairs[k].second)) return {{k, std::move(*doubt)}};
    return std::nullopt;
  }

  // All that is certain at a time since the start, up to which the run has made all collisions.
  CertainState<N> state_at(const N& time) const { return state_at(time, {}); }
  // At the last collision, of a run that ends with it: the two that have met are in one place.
  CertainState<N> state_now() const {
    CertainState<N> state = state_at(last_.time, last_);
    state.time = last_.time, state.closing = last_.closing;
    return state;
  }
  // The particle or cluster that goes by the number of one of its particles, if that is held.
  std::optional<ParticleIndex> cluster(ParticleIndex particle) const {
    if (!lines_.holds(particle)) return {};
    return lines_.cluster(particle);
  }
  // f(index, mass, place, velocity) for every particle or cluster held, by index.
  template <class F> void for_each(const N& time, F f) const {
    for (ParticleIndex b = lines_.first(); b <= lines_.last(); ++b)
      if (lines_.is_cluster(b) && !lines_.is_wall(b)) f(b, lines_.mass(b), place_at(b, time), lines_[b].velocity);
  }

  // Collisions proved, those of them that were below a threshold, those that merged, and those of which times and sides
  // were decided in plain doubles.
  struct Proved {
    std::uint64_t collisions = 0, below_cutoff = 0, merges = 0, in_doubles = 0;
  };
  const Proved& proved() const { return proved_; }

 private:
  struct Meeting {
    ParticleIndex l = -1, r = -1;  // clusters, as they are after it: the same after a merger
    N time{0}, closing{0};
  };

  CertainState<N> state_at(const N& time, const Meeting& now) const {
    CertainState<N> state;
    state.walls = accounts_, state.sizes = of_walls_;
    const auto meets = [&](ParticleIndex b) { return b == now.l || b == now.r; };
    N before{0}, present{0};
    const bool walled = walls_[0] || walls_[1];
    if (walled) check_walls(time, now, state);
    const ParticleIndex first = walled ? std::max<ParticleIndex>(lines_.first(), 0) : lines_.first(),
                        last = walled ? std::min(lines_.last(), lines_.count() - 1) : lines_.last();
    for (ParticleIndex b = first; b <= last; ++b) {
      const N mass = lines_.particles().mass(b), speed = lines_.particles().velocity(b);
      before += mass * squared(speed);
      state.sizes.add(to_double(mass), to_double(speed));
      if (!lines_.is_cluster(b)) continue;
      const Line& line = lines_[b];
      present += lines_.mass(b) * squared(line.velocity);
      const N x = place_at(b, time);
      state.widest = std::max(state.widest, power_of_ten(x.radius()));
      state.sizes.place = std::max(state.sizes.place, std::abs(to_double(x)));
      if (line.touched && !meets(b))
        if (const Order order = compare(line.changed, time); order != Order::less && !state.doubt)
          state.doubt = Doubt<N>{Check::before, order == Order::greater, b, b, line.changed, time};
      const ParticleIndex next = check_pair(b, x, time, now, state);
      if (lines_.on_ring() || !line.touched) continue;
      // Particles that no collision has reached stay between those that one has, in the order of their numbers: the
      // first of several separate regions begins at the front on the left, the last one ends at that on the right.
      const bool begins = lines_.left(b) == lines_.none || !lines_[lines_.left(b)].touched;
      if (begins && !state.front_left) state.front_left = x;
      if (next == lines_.none || !lines_[next].touched) state.front_right = x;
    }
    const bool all = lines_.first() <= 0 && lines_.last() + 1 >= lines_.count();
    const N twice = all ? present : lines_.particles().kinetic_energy() * N(2) - before + present;
    state.energy = twice * half_;
    return state;
  }
  // Takes in what stands beside them, too.
  bool are_neighbours(ParticleIndex left, ParticleIndex right) {
    if (!lines_.holds(left) || !lines_.holds(right)) return false;
    const ParticleIndex l = lines_.cluster(left), r = lines_.cluster(right);
    if (lines_.right(l) != r || l == r) return false;
    lines_.reach(l, r);
    return true;
  }

  // Level by level: those of one share no particle. What plain doubles leave open is for strike(), and so is the last
  // collision, since a run may end with it.
  std::optional<DoubtAt> side_by_side(std::span<const Pair> pairs) {
    const std::size_t last = pairs.size() - 1;
    const Proved before = proved_;
    std::uint64_t together = 0;
    std::optional<DoubtAt> first;
    levels_.begin(last);
    for (std::size_t k = 0; k < last && !first; ++k) {
      const auto [left, right] = pairs[k];
      if (lines_.inside(left, right) || are_neighbours(left, right))
        levels_.add(lines_[left], lines_[right], left);
      else
        first = {k, {Check::neighbours, true, left, right}};
    }
    levels_.sort(lines_.first(), lines_.last());
    how_.assign(pairs.size(), in_doubles);
    const auto alone = [&](std::size_t k) {
      const Proved so_far = proved_;
      auto doubt = collision(pairs[k].first, pairs[k].second);
      if (doubt && (!first || k < first->number)) first = {k, std::move(*doubt)};
      how_[k] = (proved_.in_doubles > so_far.in_doubles ? in_doubles : 0) |
                (proved_.below_cutoff > so_far.below_cutoff ? below_cutoff : 0);
    };
    Line* lines = &lines_[lines_.first()];
    for (std::size_t level = 0; level < levels_.count(); ++level)
      for (auto rest = levels_[level]; !rest.empty();) {
        const auto some = rest.first(std::min(rest.size(), Bounces<N>::most));
        rest = rest.subspan(some.size());
        for (std::size_t k = 0; k < some.size(); ++k) bounces_->put(k, lines[some[k].left], lines[some[k].right]);
        bounces_->make(some.size());
        for (std::size_t k = 0; k < some.size(); ++k) {
          const auto [left, right, number] = some[k];
          if (!bounces_->certain(k) || right == 0) {  // 0: over the seam
            alone(number);
            continue;
          }
          bounces_->get(k, lines[left], lines[right]);
          ++together;
          if (bounces_->below_cutoff(k)) ++proved_.below_cutoff, how_[number] |= below_cutoff;
        }
      }
    proved_.collisions += together, proved_.in_doubles += together;
    if (!first) alone(last);
    if (!first) return std::nullopt;
    proved_ = before;
    proved_.collisions += first->number;
    for (std::size_t k = 0; k < first->number; ++k) {
      proved_.in_doubles += (how_[k] & in_doubles) != 0;
      proved_.below_cutoff += (how_[k] & below_cutoff) != 0;
    }
    return first;
  }

  static N squared(const N& x) { return x * x; }
  static double power_of_ten(auto radius) { return static_cast<double>(std::log10(radius)); }
  [[gnu::noinline]] void check_walls(const N& time, const Meeting& now, CertainState<N>& state) const {
    for (const ParticleIndex b : {lines_.first(), lines_.last()}) {
      if (!lines_.is_wall(b)) continue;
      const N x = place_at(b, time);
      state.sizes.place = std::max(state.sizes.place, std::abs(to_double(x)));
      check_pair(b, x, time, now, state);
    }
  }
  [[gnu::always_inline]] N place_at(ParticleIndex b, const N& time) const {
    const Line& line = lines_[b];
    return line.place + line.velocity * (of_collisions_ ? time - origin(line) : time);
  }

  Order compare(const N& x, const N& y) const {
    const Order order = order_in_doubles(x, y);
    if (order != Order::open) return order;
    needed_balls_ = true;
    return order_in_balls(x, y);
  }

  // The gap right of b, which is at x; returns the particle there.
  ParticleIndex check_pair(ParticleIndex b, const N& x, const N& time, const Meeting& now,
                           CertainState<N>& state) const {
    const ParticleIndex next = lines_.right(b);
    if (next == lines_.none || next == b) return next;
    if (!(b == now.l && next == now.r)) check_gap(b, next, x, time, state);
    if (!state.over) return next;
    const N closing = lines_[b].velocity - lines_[next].velocity;
    state.over = is_negative(closing) || closing == zero_;
    return next;
  }
  void check_gap(ParticleIndex b, ParticleIndex next, const N& x, const N& time, CertainState<N>& state) const {
    N gap = place_at(next, time) - x;
    if (b == lines_.seam()) gap += length_;
    if (const Order order = compare(N(0), gap); order != Order::less && !state.doubt)
      state.doubt = Doubt<N>{Check::gap, order == Order::greater, b, next, N(0), gap};
    const double size = power_of_ten(gap.size());
    state.least_gap = std::min(state.least_gap, size);
    state.widest_of_gap = std::max(state.widest_of_gap, power_of_ten(gap.radius()) - size);
  }

  // Places of both at one time, in the image of the one on the right.
  struct Places {
    N left, right, time{0};
  };
  // Where a law is not linear, errors of velocities act on places from one collision to the next, and would from the
  // start if that were the time that places are of: these are of a time near the collision. Other laws know no time.
  Places places_of(const Line& l, const Line& r, const N& closing, bool over_seam) const {
    Places at{l.place, r.place};
    if (over_seam) at.left -= length_;
    if (!of_collisions_) return at;
    const N &of_l = origin(l), &of_r = origin(r);
    const N then = to_double(of_l) < to_double(of_r) ? of_r : of_l;
    at.left += l.velocity * (then - of_l), at.right += r.velocity * (then - of_r);
    const N near = N((then - (at.left - at.right) / closing).middle(), 0), on = near - then;
    return {at.left + l.velocity * on, at.right + r.velocity * on, near};
  }
  // The time that a line's place is of.
  N origin(const Line& line) const { return of_collisions_ && line.touched ? N(line.changed.middle(), 0) : zero_; }

  [[gnu::flatten]] std::optional<Doubt<N>> strike(ParticleIndex at_l, ParticleIndex at_r) {
    needed_balls_ = false;
    Line &l = lines_[at_l], &r = lines_[at_r];
    const N closing = l.velocity - r.velocity;
    if (!is_positive(closing)) return Doubt<N>{Check::closing, is_negative(closing), -1, -1, zero_, closing};
    const bool over_seam = at_l == lines_.seam();
    Places at = places_of(l, r, closing, over_seam);
    const N apart = at.left - at.right, after = -(apart / closing);
    N time = after;
    if (of_collisions_) time += at.time;
    for (const Line* line : {&l, &r}) {
      if (!line->touched) continue;
      if (const Order order = compare(line->changed, time); order != Order::less)
        return Doubt<N>{Check::later, order == Order::greater, -1, -1, line->changed, time};
    }
    if (lines_.is_wall(at_l) || lines_.is_wall(at_r)) return strike_wall(at_l, at_r, at, closing, after, time);
    CertainOutcome<N>& outcome = outcome_;
    outcome.clear();
    if (const auto open = outcome_of(at_l, at_r, closing, time, outcome))
      return Doubt<N>{Check::side, false, -1, -1, open->first, open->second};
    apply(outcome, at, apart, closing, l, r);
    if (over_seam) (outcome.event == Event::pass ? r : l).place += length_;
    l.changed = time;
    if (of_collisions_) l.changed = N::widened(at.time, after.size());
    r.changed = l.changed;
    l.touched = r.touched = true;
    last_.l = at_l, last_.r = outcome.event == Event::merge ? at_l : at_r, last_.time = time, last_.closing = closing;
    if (outcome.event == Event::pass) std::swap(last_.l, last_.r);
    ++proved_.collisions;
    proved_.in_doubles += !needed_balls_;
    proved_.below_cutoff += outcome.below_cutoff;
    proved_.merges += outcome.event == Event::merge;
    if (outcome.event == Event::merge) lines_.merge(at_l, at_r);
    if (outcome.event == Event::pass) lines_.pass(at_l, at_r);
    return std::nullopt;
  }

  // Of one that is known to be later than the last one of the particle.
  [[gnu::noinline]] std::optional<Doubt<N>> strike_wall(ParticleIndex at_l, ParticleIndex at_r, const Places& places,
                                                        const N& closing, const N& after, const N& time) {
    const End end = lines_.is_wall(at_l) ? End::left : End::right;
    const bool left = end == End::left;
    const ParticleIndex struck = left ? at_r : at_l;
    Line& line = lines_[struck];
    const N mass = lines_.mass(struck), &wall_place = left ? places.left : places.right;
    N place = left ? places.right : places.left;
    CertainAccount<N>& account = accounts_[number_of(end)];
    const double given = to_double(account.given);
    const typename CertainWall<N>::Meeting meeting{
        place, line.velocity, wall_place, lines_[left ? at_l : at_r].velocity, closing, after};
    if (!(*walls_[number_of(end)])(meeting, mass, account))
      return Doubt<N>{Check::side, false, -1, -1, mass, N(to_double(mass))};
    line.place = place;
    line.changed = of_collisions_ ? N::widened(places.time, after.size()) : time;
    line.touched = true;
    of_walls_.wall_speed = std::max(
        {of_walls_.wall_speed, std::abs(to_double(line.velocity)), std::abs(to_double(meeting.wall_velocity))});
    of_walls_.wall_energy += std::max(0., to_double(account.given) - given);
    last_ = {at_l, at_r, time, closing};
    ++proved_.collisions;
    proved_.in_doubles += !needed_balls_;
    return std::nullopt;
  }

  typename CertainLaws<N>::Open outcome_of(ParticleIndex at_l, ParticleIndex at_r, const N& closing, const N& time,
                                           CertainOutcome<N>& outcome) const {
    const Line &l = lines_[at_l], &r = lines_[at_r];
    CertainCollision<N> collision{closing, {}, {}, &l.velocity, &r.velocity};
    if (laws_.law.contact_time) {
      if (l.touched) collision.left_rest = time - l.changed;
      if (r.touched) collision.right_rest = time - r.changed;
    }
    const auto order = [this](const N& x, const N& y) { return compare(x, y); };
    if (lines_.identical_masses()) return laws_(collision, zero_, zero_, true, order, outcome);
    return laws_(collision, lines_.mass(at_l), lines_.mass(at_r), false, order, outcome);
  }

  void apply(const CertainOutcome<N>& outcome, const Places& at, const N& apart, const N& closing, Line& l,
             Line& r) const {
    if (outcome.exchange) {
      l.place = at.right, r.place = at.left;
      std::swap(l.velocity, r.velocity);
      return;
    }
    const Share &of_l = outcome.left ? *outcome.left : laws_.bouncing,
                &of_r = outcome.right ? *outcome.right : laws_.bouncing;
    const auto places = N::combined(at.left, at.right, apart, of_l, of_r);
    const auto velocities = N::combined(l.velocity, r.velocity, closing, of_l, of_r);
    if (outcome.right_heavier) {  // from the heavier one: the uncertainty of the share then acts on a small difference
      l.place = places.right, l.velocity = velocities.right;
      return;
    }
    l.place = places.left, r.place = places.right;
    l.velocity = outcome.left_velocity ? *outcome.left_velocity : velocities.left;
    r.velocity = outcome.right_velocity ? *outcome.right_velocity : velocities.right;
  }

  static std::size_t number_of(End end) { return static_cast<std::size_t>(end); }

  CertainLaws<N> laws_;
  WorldLines<N> lines_;
  std::array<std::optional<CertainWall<N>>, 2> walls_;
  CertainAccounts<N> accounts_;
  Sizes of_walls_;  // only what walls add to them
  N length_, zero_{0};
  N half_;
  bool of_collisions_;  // laws that are not linear: places are of the time of a particle's last collision, not of the
                        // start
  Proved proved_;
  Meeting last_;
  CertainOutcome<N> outcome_;  // of the collision at hand
  mutable bool needed_balls_ = false;

  // ---- of collisions side by side
  std::optional<Bounces<N>> bounces_;
  Levels levels_;
  static constexpr std::size_t most_at_once = 2048;  // so that lists stay in the nearest caches
  static constexpr std::uint8_t in_doubles = 1, below_cutoff = 2;
  std::vector<std::uint8_t> how_;  // each collision was decided
};

}  // namespace cradle
