#pragma once
// `Checker` proves that a run is right. It is given the collisions of the run one by one, as pairs of neighbours. From
// the decimals of the scene it computes the world lines of all particles, every number enclosed in a ball
// (precision/ball.hpp), and it checks the conditions under which these lines are the motion of the exact system. It
// shares no arithmetic with the engine that proposes the collisions.
//
// README.md says what is checked at the start, at each collision and at a time to which the run is to be proved, and
// proves that this is enough: also for walls, under gravity and for particles that merge or pass.

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "cradle/core/certify/inspection.hpp"
#include "cradle/core/certify/side_by_side.hpp"

namespace cradle {

template <Enclosing N> class Checker {
 public:
  using Share = typename N::Share;
  using Line = WorldLine<N>;
  using Places = typename Motion<N>::Places;

  Checker(std::shared_ptr<const Particles<N>> particles, const CertainLaw<N>& law)
      : laws_(law), motion_(std::move(particles), law), walls_(motion_.lines.particles()) {
    if constexpr (SideBySide<N>)
      if (law.bounces_only() && !motion_.of_collisions && motion_.lines.identical_masses() && !law.contact_time)
        in_levels_.emplace(laws_.bouncing, law.cutoff ? *law.cutoff : N(-1), law.elastic);
  }

  // The particles at the start.
  std::optional<Doubt<N>> begin() const { return state_at(N(0)).doubt; }

  // The next collision of the run. Where it is in doubt, no world line is changed.
  std::optional<Doubt<N>> collision(ParticleIndex left, ParticleIndex right) {
    if (!are_neighbours(left, right)) return Doubt<N>{Check::neighbours, true, left, right};
    auto doubt = strike(motion_.lines.cluster(left), motion_.lines.cluster(right));
    if (doubt && doubt->left == doubt->right) doubt->left = left, doubt->right = right;
    return doubt;
  }

  // The next ones in turn. Those before the one in doubt are proved; after it nothing more can be checked.
  using Pair = std::pair<ParticleIndex, ParticleIndex>;
  std::optional<DoubtAt<N>> collisions(std::span<const Pair> pairs) {
    if constexpr (SideBySide<N>) {
      const auto neighbours = [this](ParticleIndex l, ParticleIndex r) { return are_neighbours(l, r); };
      const auto collide = [this](ParticleIndex l, ParticleIndex r) { return collision(l, r); };
      constexpr std::size_t most = InLevels<N>::most;
      for (std::size_t begin = 0; in_levels_ && begin < pairs.size(); begin += most)
        if (auto doubt = (*in_levels_)(pairs.subspan(begin, std::min(most, pairs.size() - begin)), motion_.lines,
                                       proved_, neighbours, collide)) {
          doubt->number += begin;
          return doubt;
        }
      if (in_levels_) return std::nullopt;
    }
    for (std::size_t k = 0; k < pairs.size(); ++k)
      if (auto doubt = collision(pairs[k].first, pairs[k].second)) return {{k, std::move(*doubt)}};
    return std::nullopt;
  }

  // All that is certain at a time since the start, up to which the run has made all collisions.
  CertainState<N> state_at(const N& time) const { return Inspection<N>(motion_, walls_, time, {}).state; }
  // At the last collision, of a run that ends with it: the two that have met are in one place.
  CertainState<N> state_now() const {
    CertainState<N> state = Inspection<N>(motion_, walls_, last_.time, last_).state;
    state.time = last_.time, state.closing = last_.closing;
    return state;
  }
  // The particle or cluster that goes by the number of one of its particles, if that is held.
  std::optional<ParticleIndex> cluster(ParticleIndex particle) const {
    if (!motion_.lines.holds(particle)) return {};
    return motion_.lines.cluster(particle);
  }
  // f(index, mass, place, velocity) for every particle or cluster held, by index.
  template <class F> void for_each(const N& time, F f) const {
    for (ParticleIndex b = motion_.lines.first(); b <= motion_.lines.last(); ++b)
      if (motion_.lines.is_cluster(b) && !motion_.lines.is_wall(b))
        f(b, motion_.lines.mass(b), motion_.place_at(b, time), motion_.velocity_at(b, time));
  }

  const Proved& proved() const { return proved_; }
  // The last one that `collision` has proved.
  const LastMeeting<N>& last() const { return last_; }

 private:
  // Takes in what stands beside them, too.
  bool are_neighbours(ParticleIndex left, ParticleIndex right) {
    if (!motion_.lines.holds(left) || !motion_.lines.holds(right)) return false;
    const ParticleIndex l = motion_.lines.cluster(left), r = motion_.lines.cluster(right);
    if (motion_.lines.right(l) != r || l == r) return false;
    motion_.lines.reach(l, r);
    return true;
  }

  [[gnu::flatten]] std::optional<Doubt<N>> strike(ParticleIndex at_l, ParticleIndex at_r) {
    motion_.needed_balls = false;
    const bool at_wall = motion_.lines.is_wall(at_l) || motion_.lines.is_wall(at_r);
    if (at_wall && walls_.pulled()) return strike_falling(at_l, at_r);
    Line &l = motion_.lines[at_l], &r = motion_.lines[at_r];
    const N closing = l.velocity - r.velocity;
    if (!is_positive(closing)) return Doubt<N>{Check::closing, is_negative(closing), -1, -1, motion_.zero, closing};
    const bool over_seam = at_l == motion_.lines.seam();
    const Places at = motion_.places_of(l, r, closing, over_seam);
    const N apart = at.left - at.right, after = -(apart / closing);
    N time = after;
    if (motion_.of_collisions) time += at.time;
    for (const Line* line : {&l, &r})
      if (line->touched)
        if (auto doubt = not_after(line->changed, time)) return doubt;
    if (at_wall) {
      const LastMeeting<N> meeting{at_l, at_r, time, closing};
      if (auto doubt = walls_.strike(motion_, meeting, at, after)) return doubt;
      return made(meeting, false);
    }
    if (walls_.pulled())
      for (const ParticleIndex b : {at_l, at_r})
        if (auto doubt = walls_.stays_open(motion_, b, time)) return doubt;
    CertainOutcome<N>& outcome = outcome_;
    outcome.clear();
    if (const auto open = outcome_of(at_l, at_r, closing, time, outcome))
      return Doubt<N>{Check::side, false, -1, -1, open->first, open->second};
    apply(outcome, at, apart, closing, l, r);
    if (over_seam) (outcome.event == Event::pass ? r : l).place += motion_.length;
    l.changed = time;
    if (motion_.of_collisions) l.changed = N::widened(at.time, after.size());
    r.changed = l.changed;
    l.touched = r.touched = true;
    if (walls_.pulled()) walls_.met(at_l, at_r, outcome.exchange);
    const bool merge = outcome.event == Event::merge, pass = outcome.event == Event::pass;
    proved_.merges += merge;
    if (merge) motion_.lines.merge(at_l, at_r);
    if (pass) motion_.lines.pass(at_l, at_r);
    return made({pass ? at_r : at_l, merge || pass ? at_l : at_r, time, closing}, outcome.below_cutoff);
  }
  std::optional<Doubt<N>> not_after(const N& last, const N& time) const {
    const Order order = motion_.compare(last, time);
    if (order == Order::less) return {};
    return Doubt<N>{Check::later, order == Order::greater, -1, -1, last, time};
  }
  std::optional<Doubt<N>> made(LastMeeting<N> meeting, bool below_cutoff) {
    last_ = std::move(meeting);
    ++proved_.collisions;
    proved_.in_doubles += !motion_.needed_balls;
    proved_.below_cutoff += below_cutoff;
    return {};
  }

  // With a wall, under gravity, where the law's cut-off and contact time hold for it too (chains/gravity.hpp).
  [[gnu::noinline]] std::optional<Doubt<N>> strike_falling(ParticleIndex at_l, ParticleIndex at_r) {
    const bool left = motion_.lines.is_wall(at_l);
    typename CertainWalls<N>::Approaching at{left ? at_l : at_r, left ? at_r : at_l};
    if (auto doubt = walls_.approach(motion_, at)) return doubt;
    const Line& struck = motion_.lines[at.struck];
    // A particle that rises from a floor, or falls from a ceiling, would have been there before the start.
    if (auto doubt = not_after(struck.touched ? struck.changed : motion_.zero, at.time)) return doubt;
    if (auto doubt = walls_.stays_open(motion_, at.struck, at.time, at.wall)) return doubt;
    const auto less = [this](const N& x, const std::optional<N>& y, bool& is) -> std::optional<Doubt<N>> {
      if (!y) return {};
      const Order order = motion_.compare(x, *y);
      if (order == Order::open) return Doubt<N>{Check::side, false, -1, -1, x, *y};
      is = order == Order::less;
      return {};
    };
    bool slow = false, soon = false;
    const CertainLaw<N>& law = laws_.law;
    if (auto doubt = law.contact_time ? std::nullopt : less(at.closing, law.cutoff, slow)) return doubt;
    if (struck.touched)
      if (auto doubt = less(at.time - struck.changed, law.contact_time, soon)) return doubt;
    if (auto doubt = walls_.strike(motion_, at, slow || soon)) return doubt;
    return made({at_l, at_r, at.time, at.closing}, (slow || soon) && walls_.reflects(at.wall));
  }

  typename CertainLaws<N>::Open outcome_of(ParticleIndex at_l, ParticleIndex at_r, const N& closing, const N& time,
                                           CertainOutcome<N>& outcome) const {
    const Line &l = motion_.lines[at_l], &r = motion_.lines[at_r];
    CertainCollision<N> collision{closing, {}, {}, &l.velocity, &r.velocity};
    if (laws_.law.contact_time) {
      if (l.touched) collision.left_rest = time - l.changed;
      if (r.touched) collision.right_rest = time - r.changed;
    }
    const auto order = [this](const N& x, const N& y) { return motion_.compare(x, y); };
    if (motion_.lines.identical_masses()) return laws_(collision, motion_.zero, motion_.zero, true, order, outcome);
    return laws_(collision, motion_.lines.mass(at_l), motion_.lines.mass(at_r), false, order, outcome);
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

  CertainLaws<N> laws_;
  Motion<N> motion_;
  CertainWalls<N> walls_;
  Proved proved_;
  LastMeeting<N> last_;
  CertainOutcome<N> outcome_;  // of the collision at hand
  std::optional<InLevels<N>> in_levels_;
};

}  // namespace cradle
