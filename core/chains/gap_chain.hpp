#pragma once
// The chain in gaps and closing speeds: for neighbours l, r the gap g >= 0 and the closing speed w = v_l - v_r. A
// collision transfers an impulse J from left to right and changes three gaps:
//
//   w[i] -> w',   w[i-1] += J/m_l,   w[i+1] += J/m_r,   g[i] = 0 exactly.
//
// No gap is a difference of positions, so gaps keep their relative precision down to underflow, however small they are
// against the size of the system (timed_gaps.hpp: how they are advanced, and how rounding acts).
//
// Under gravity (gravity.hpp) gaps to walls are parabolas of time, those to shaken walls other curves, and collisions
// at them or beside them are made off the hot path; all others are as without it.
//
// Rows are streamed (held_range.hpp). Velocities and positions come from the two anchors: the particles that end the
// active zone, whose flight is known (anchor.hpp). On a ring the gap after the last slot is the first one; there
// positions come from the centre of mass, velocities from the total momentum.

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/anchor.hpp"
#include "cradle/core/chains/collision_memory.hpp"
#include "cradle/core/chains/collision_result.hpp"
#include "cradle/core/chains/configuration.hpp"
#include "cradle/core/chains/gap_line.hpp"
#include "cradle/core/chains/held_range.hpp"
#include "cradle/core/laws/one_of.hpp"
#include "cradle/core/queue/account.hpp"
#include "cradle/core/queue/relative_motion.hpp"

namespace cradle {

// How the front at one end of a line has moved in a held range (segments.hpp): the outermost slot with a collision, and
// the collisions at the last gap of the line, with the velocity that each gave to the last particle.
template <Real T> struct FrontMove {
  struct AtEnd {
    T time, handed;
  };
  Slot reached = 0;
  std::vector<AtEnd> at_end;
  WallTally<T> wall;  // of the wall at this end
};

template <Real T, class Masses = IdenticalMasses<T>, class Field = NoGravity<T>> class GapChain {
 public:
  using Scalar = T;
  using Line = GapLine<T, Masses>;
  static constexpr bool falls = Field::acts;
  static constexpr bool may_collapse = true;
  static constexpr bool keys_are_exact = Line::Gaps::keys_are_exact;

  // Holds the gaps in motion and streams the others in as the fronts reach them; `hold_all` holds every gap from the
  // start. Throws std::invalid_argument for masses that differ if the chain is for identical ones.
  GapChain(std::shared_ptr<const Particles<T>> particles, const T& start, bool hold_all = false)
      : GapChain(particles, start, hold_all ? particles->gaps() : particles->gaps_in_motion()) {}

  // ---- times: local ones are offsets from an origin that moves
  const Clock<T>& clock() const { return line_.gaps.clock(); }
  const T& start() const { return clock().start(); }
  T local_time(const T& time) const { return clock().offset(time); }
  Pair<T> stamp(const T& local) const { return clock().stamp(local); }
  double queue_time(const T& local) const { return line_.gaps.queue_time(local); }

  // ---- slots: the gaps held are first() to last()
  std::size_t slots() const { return line_.gaps.slots(); }
  Slot first() const { return range_.first(); }
  Slot last() const { return range_.last(); }
  Slot left(Slot s) const { return on_ring() && s == first() ? last() : s - 1; }
  Slot right(Slot s) const { return on_ring() && s == last() ? first() : s + 1; }
  bool on_ring() const { return range_.on_ring(); }
  ParticleIndex particle(Slot s) const { return line_.particle(s); }
  ParticleIndex count() const { return particles_->count(); }
  ParticleIndex collided_particles() const {
    if (on_ring()) return particles_->count();
    return range_.has_fronts() ? front_particle(End::right) - front_particle(End::left) + 1 : 0;
  }

  // Local time of the next collision of a gap that is closing.
  T due(Slot s) const {
    if constexpr (falls && !keys_are_exact)
      if (field_.pulls(particle(s))) return line_.due(field_, s).value_or(far_away<T>());
    return line_.due(s);
  }
  double queue_due(Slot s) const {
    if constexpr (falls && !keys_are_exact)
      if (field_.pulls(particle(s))) return line_.queue_due(field_, s);
    return line_.queue_due(s);
  }
  // At the gap's local time; at another time; at its next collision.
  const T& closing(Slot s) const { return line_.closing(s); }
  T closing_at(Slot s, const T& time) const {
    if constexpr (falls)
      if (field_.pulls(particle(s))) return line_.closing_at(field_, s, time);
    return closing(s);
  }
  T closing_when_due(Slot s) const {
    if constexpr (falls)
      if (field_.pulls(particle(s))) return line_.approach(field_, s).meeting_speed().value_or(T(0));
    return closing(s);
  }

  // ---- events (inlined by force, see gap_line.hpp)
  template <class Law>
  [[gnu::always_inline]] CollisionResult<T> collide(const Law& law, Slot s, const T& time) requires(Law::bounces_only) {
    if constexpr (falls) {  // beside the gap to a wall, or in or above a pile, too
      if (!inner_.has(s)) [[unlikely]]
        return collide_at_end(law, s, time);
    } else {
      if (!range_.inside(s, s)) [[unlikely]]
        return collide_at_end(law, s, time);
    }
    return line_.strike(s - 1, s, s + 1, time, outcome(law, s, time, closing(s)), Notice::none);
  }

  // Moves the origin of time to the given local time and returns its new local time. Gaps do not change.
  T move_origin(const T& local) {
    if constexpr (Line::watched)
      if (!shaken()) line_.certainty.begin_anew(line_.gaps, line_.motion(field_), first(), last());
    find_lost_digits(local);
    line_.gaps.move_origin(local, [this](auto&& each) {
      for (Slot s = first(); s <= last(); ++s) each(s, closing(s));
    });
    foresee_walls();
    memory_.move_origin(local);
    for (Anchor<T>* anchor : {&left_, &right_}) anchor->move_origin(local);
    return T(0);
  }

  void make_room() {
    std::vector<Slot> kept(last() + 1 - first());
    std::iota(kept.begin(), kept.end(), first());
    lay_out(kept, static_cast<ParticleIndex>(kept.size()));
  }

  // Collisions after which a neighbouring gap is below `floor` are noticed (gap_below_floor).
  void set_floor(const T& floor) { line_.gaps.set_floor(floor); }
  // The smaller gap next to a collision, at its local time; beyond an end of the line it is far away.
  T nearest_gap(Slot s) const {
    const T far = far_away<T>();
    const T on_left = on_ring() || s > first() ? line_.gaps[left(s)].gap : far,
            on_right = on_ring() || s < last() ? line_.gaps[right(s)].gap : far;
    return on_left < on_right ? on_left : on_right;
  }
  // After a collision at s, if it was with a floor (gravity.hpp).
  std::optional<Rebound<T>> rebound(Slot s) const requires(falls) {
    return field_.rebound(particle(s), closing(s), line_.gaps.since_start(s));
  }
  const Account<T>& account() const { return line_.gaps.account(); }
  void lose(Slot s, const T& energy) { line_.gaps.lose(s, energy); }
  T energy_lost() const { return line_.gaps.energy_lost(first(), last()); }
  // The smallest difference between two collision times that is resolved, as a time since the start.
  T time_resolution(Slot, const T& time) const { return line_.gaps.time_resolution(time); }

  // The left particle of a gap for which rounding may decide whether it closes up to a local time, which must not be
  // before the last collision. Where deviations are not watched, they are taken for a few roundings of the largest
  // speed at the start.
  std::optional<ParticleIndex> uncertain_at(const T& time) const {
    for (Slot s = first(); s <= last(); ++s)
      if (open(s, time)) return particle(s);
    return {};
  }
  // About how far rounding has moved the kinetic energy by this time, from the larger sample.
  T energy_deviation(const T& time) const requires(Line::watched);
  // The outcome of a collision at the speed 1, if all outcomes are proportional to the speed.
  template <class Law> std::optional<Outcome<T>> at_unit_speed(const Law& law, Slot s) const {
    if (walls_.beside(particle(s)))
      return walls_.at_unit_speed(particle(s), line_.masses[walls_.left_of(particle(s)) ? s + 1 : s]);
    return law(T(1), line_.masses.of_pair(s));
  }

  // ---- reading, at a local time not before the last collision
  T gap_at(Slot s, const T& time) const {
    if constexpr (falls)
      if (field_.pulls(particle(s))) return line_.gap_at(field_, s, time);
    return line_.gaps.gap_at(s, closing(s), time);
  }
  // Positions of the outermost particles that have collided; there must be some.
  T front_left(const T& time) const;
  T front_right(const T& time) const;
  const Walls<T>& walls() const { return walls_; }
  // The accounts of the walls until a local time, with what they have given to particles that rest on one since.
  // (gap_chain_walls.hpp)
  Walls<T> walls_at(const T& time) const requires(falls);
  // Of all particles of the scene; reads all held gaps. (gap_chain_configuration.hpp)
  T kinetic_energy(const T& time) const {
    return kinetic_energy(time, [&](Slot s) { return closing_at(s, time); });
  }

  static auto state(auto& self) {
    const auto all = std::tie(self.line_, self.range_, self.memory_, self.left_, self.right_, self.walls_);
    if constexpr (falls)
      return std::tuple_cat(all, std::tie(self.field_));
    else
      return all;
  }
  void loaded();  // checks what was loaded (gap_chain_state.hpp)

  // ---- for segments (segments.hpp)
  const Particles<T>& particles() const { return *particles_; }
  const Line& line() const { return line_; }
  void lose(const Ledger<T>& elsewhere) { line_.gaps.lose(elsewhere); }
  ParticleIndex place(Slot s) const { return particle(s); }  // in the order of the line, for any numbering of slots
  // Slots free for particles that the fronts reach.
  std::size_t within_reach_left() const { return range_.free_left(); }
  std::size_t within_reach_right() const { return range_.free_right(slots()); }
  bool cramped(std::size_t particles) const { return range_.cramped(slots(), static_cast<ParticleIndex>(particles)); }
  bool fronts_are_within(Slot left, Slot right) const {
    return on_ring() || (range_.has_fronts() && range_.front_left() <= left && range_.front_right() >= right);
  }
  Slot front_slot_left() const { return range_.front_left(); }
  Slot front_slot_right() const { return range_.front_right(); }
  // Replaces the gaps by those of a held range, in the same slots and in those that the fronts have reached.
  // (gap_chain_ends.hpp)
  void continue_with(typename Line::Gaps& after, const FrontMove<T>& to_left, const FrontMove<T>& to_right);

  // The particles that have collided and the next one on each side; before the first collision all held ones. On a ring
  // all particles, from the first one right of x = 0. (gap_chain_configuration.hpp)
  Configuration<T> configuration(const T& time) const;

 private:
  GapChain(std::shared_ptr<const Particles<T>> particles, const T& start, GapRange held)
      : particles_(std::move(particles)), line_(*particles_, start),
        range_(particles_->on_ring(), held.first - particles_->gaps().first, particles_->gaps().last - held.last, 2),
        walls_(particles_->walls()), field_(*particles_) {
    require_particles(*particles_, start);
    if (!falls) require_no_gravity(*particles_, "use GapChain<T, Masses, Gravity<T>>");
    lay_out({}, held.last - held.first + 1);
    for (Slot s = first(); s <= last(); ++s) line_.load(s, *particles_, T(0));
    foresee_walls();
    if constexpr (Line::watched && falls)
      for (Slot s = first(); s <= last(); ++s)
        if (field_.pulls(particle(s))) line_.watch_meeting(field_, s, T(0));
    find_inner();
    left_.take(particle(first()));
    right_.take(particle(last()) + 1);
    for (Slot s = first(); s <= last(); ++s) fastest_ = std::max(fastest_, magnitude(closing(s)));
    if (!on_ring()) return;
    range_.place_seam();
    centre_ = particles_->centre_of_mass();
  }

  template <class Closing> T kinetic_energy(const T& time, const Closing& closing_at) const;
  // On a ring, or between two walls that are not shaken, closing speeds add up to a number that is known. What their
  // sum misses of it is rounding, of the size of that of the first closing speeds: a system that has cooled to that
  // size is another one.
  bool closed() const { return on_ring() || (!falls && walls_.has(End::left) && walls_.has(End::right)); }
  void find_lost_digits(const T& time);
  static constexpr int certain_by = 64;  // as in Deviation
  // How much the rounding of the first and of this time leaves open of the time between them, which decimals give.
  T off_by(const T& time) const {
    return T(std::numeric_limits<T>::epsilon()) * (magnitude(start()) + magnitude(clock().time(time)));
  }
  // Whether a collision at this gap may come before or after the end of the run.
  bool open(Slot s, const T& time) const;

  Configuration<T> line_configuration(const T& time) const;
  Configuration<T> ring_configuration(const T& time) const;
  Flight<T> flight(const Anchor<T>& anchor, const T& time) const {
    if constexpr (falls)
      if ((field_.resting() == count() || (count() == 1 && particles_->holding() != nullptr)) &&
          particles_->wall_at(anchor.particle()) == nullptr)
        return from_wall(time);
    return anchor.flight(*particles_, clock(), time);
  }
  // The flight of a particle that rests on a wall, alone or on a pile of all others, or of a single one that may rest
  // there. (gap_chain_walls.hpp)
  Flight<T> from_wall(const T& time) const;

  // Predicts the next collisions with walls under gravity, where all others have just been. (gap_chain_walls.hpp)
  void foresee_walls();
  // Whether a loaded gap has numbers that a gap can have. (gap_chain_state.hpp)
  bool fits(Slot s) const;

  // Under gravity, the slots in which a collision concerns no end, wall or pile, nor a gap beside one.
  struct Inner {
    Slot after = 0, before = 0;
    bool has(Slot s) const { return (s > after) & (s < before); }
  };
  void find_inner() {
    if constexpr (falls) {
      const auto pile = static_cast<Slot>(field_.resting());
      const bool left = field_.pile_end() == End::left;
      const Slot front = range_.front_right(), margin = left ? 1 : 1 + pile;
      inner_ = {range_.front_left() + (left ? 1 + pile : 1), front > margin ? front - margin : 0};
    }
  }
  // So many particles from the wall.
  Slot slot_in_pile(ParticleIndex height) const {
    const auto h = static_cast<Slot>(height);
    return field_.pile_end() == End::left ? first() + h : last() - h;
  }

  Slot slot(ParticleIndex particle) const {
    return static_cast<Slot>(particle - line_.particle_of_slot_0);
  }  // of the gap right of it
  // The outermost particle that has collided; walls are not counted.
  ParticleIndex front_particle(End end) const {
    return end == End::left ? std::max<ParticleIndex>(particle(range_.front_left()), 0)
                            : std::min(particle(range_.front_right()) + 1, particles_->count() - 1);
  }

  // The last particle of a line, or the wall there, has had a collision in which it gained velocity.
  template <class Gain> void follow_end(End end, ParticleIndex particle, const T& time, const Gain& gain) {
    Anchor<T>& anchor = end == End::left ? left_ : right_;
    anchor.take(particle);
    if (!walls_.has(end)) anchor.follow(flight(anchor, time), time, gain);
  }

  // Changes to enough slots for the zone to grow by half on either side, with the gaps at `kept`. (gap_chain_ends.hpp)
  void lay_out(const std::vector<Slot>& kept, ParticleIndex held);

  template <LawChoice Law>
  [[gnu::always_inline]] Outcome<T> outcome(const Law& law, Slot s, const T& time, const T& w) {
    return law.visit([&](const auto& own) { return outcome(own, s, time, w); });
  }
  template <class Law> [[gnu::always_inline]] Outcome<T> outcome(const Law& law, Slot s, const T& time, const T& w) {
    if constexpr (Line::watched && requires { law.cutoff(); })
      line_.certainty.threshold(line_.gaps, line_.motion(field_), s, particle(s), time, w, law.cutoff());
    if constexpr (LawWithMemory<Law, T>)
      if (!memory_.rested({left(s), s, right(s)}, s, time, law.contact_time(), local_time(start()), slots()))
        return law.elastic(w, line_.masses.of_pair(s));
    const Outcome<T> outcome = law(w, line_.masses.of_pair(s));
    if constexpr (Line::watched && !requires { law.cutoff(); })
      line_.certainty.slope(law, w, line_.masses.of_pair(s), outcome);
    return outcome;
  }
  template <LawChoice Law> Outcome<T> outcome_at_wall(const Law& law, Slot s, const T& time) {
    return law.visit([&](const auto& own) { return outcome_at_wall(own, s, time); });
  }
  template <class Law> Outcome<T> outcome_at_wall(const Law& law, Slot s, const T& time);
  // A collision at an end of the active zone, at the seam of a ring or at a wall.
  template <class Law> [[gnu::noinline]] CollisionResult<T> collide_at_end(const Law& law, Slot s, const T& time) {
    if constexpr (falls) {
      return collide_falling(law, s, time);
    } else {
      const Outcome<T> of_law =
          walls_.beside(particle(s)) ? outcome_at_wall(law, s, time) : outcome(law, s, time, closing(s));
      const Notice notice = on_ring() ? Notice::none : widen(s, time, of_law);
      return line_.strike(left(s), s, right(s), time, of_law, notice);
    }
  }
  // The same under gravity or between shaken walls, also beside the gap to one and at a pile. (gap_chain_walls.hpp)
  template <class Law> CollisionResult<T> collide_falling(const Law& law, Slot s, const T& time);
  // Whether the next particle at the wall or the pile there comes to rest on it.
  bool stays(Slot s, const T& time) const {
    return field_.holds(particle(s), closing_when_due(s), clock().since_start(time));
  }

  bool shaken() const {
    if constexpr (falls)
      return field_.shaken();
    else
      return false;
  }

  // What a wall has given, until a local time, to a particle that rests on it, at this gap or with this gap below it in
  // a pile. (gap_chain_walls.hpp)
  struct Carried {
    End end;
    T energy{0}, momentum{0};
  };
  Carried carried(Slot s, const T& time) const;
  void enter_carried(Slot s, const T& time);

  // A collision at an end of the active zone: takes in the next particle there or, at an end of the line, follows the
  // last one.
  Notice widen(Slot s, const T& time, const Outcome<T>& outcome);

  std::shared_ptr<const Particles<T>> particles_;
  Line line_;
  HeldRange range_;
  CollisionMemory<T> memory_;
  T centre_{0};   // on a ring: centre of mass at the start
  T fastest_{0};  // closing speed at the start
  Anchor<T> left_, right_;
  Walls<T> walls_;
  [[no_unique_address]] Field field_;
  [[no_unique_address]] std::conditional_t<falls, Inner, NothingMore> inner_;
};

}  // namespace cradle

#include "cradle/core/chains/gap_chain_configuration.hpp"
#include "cradle/core/chains/gap_chain_ends.hpp"
#include "cradle/core/chains/gap_chain_state.hpp"
#include "cradle/core/chains/gap_chain_walls.hpp"
