#pragma once
// `GapChain` holds the particles as gaps and closing speeds: README.md (GapChain) says how, and why no gap is computed
// as a difference of positions; timed_gaps.hpp says how gaps are advanced and how rounding acts on them.
//
// Under gravity (gravity.hpp) the gap to a wall is a parabola in time; the gap to a shaken wall is another curve.
// Collisions at such a gap or beside it are made off the hot path, all others as without gravity. Only code off the hot
// path asks whether there is gravity or a shaken wall.
//
// This file has the collisions; the classes from which `GapChain` is derived have the gaps that are held
// (held_gaps.hpp), their positions and velocities (gap_places.hpp), and the ends of the active zone (gap_ends.hpp).
//
// README.md says how particles of a row are added when they are hit (Streaming), and what several particles do that
// rest on a wall, one on the other (Piles).

#include <numeric>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/gap_ends.hpp"
#include "cradle/core/laws/one_of.hpp"

namespace cradle {

template <Real T, class Masses = IdenticalMasses<T>> class GapChain : public GapEnds<T, Masses> {
  using Ends = GapEnds<T, Masses>;

 public:
  using Ends::falls, Ends::keys_are_exact, Ends::clock, Ends::local_time, Ends::slots, Ends::first, Ends::last;
  using Ends::left, Ends::right, Ends::on_ring, Ends::particle, Ends::closing, Ends::closing_when_due;
  using typename Ends::Line;

  // Holds the gaps in motion and streams the others in as the fronts reach them; `hold_all` holds every gap from the
  // start. Throws std::invalid_argument for masses that differ if the chain is for identical ones.
  GapChain(const std::shared_ptr<const Particles<T>>& particles, const T& start, bool hold_all = false)
      : GapChain(particles, start, hold_all ? particles->gaps() : particles->gaps_in_motion()) {}

  // The chain of other particles, in the memory of this one.
  void begin_again(const std::shared_ptr<const Particles<T>>& particles) {
    const T start = Ends::start();
    const GapRange held = particles->gaps_in_motion();
    *this = GapChain(particles, start, held, line_.gaps.leave());
  }

  // ---- events (inlined by force, see gap_line.hpp)
  template <class Law>
  [[gnu::always_inline]] CollisionResult<T> collide(const Law& law, Slot s, const T& time) requires(Law::bounces_only) {
    if (!is_inner(s)) [[unlikely]]
      return collide_at_end(law, s, time);
    return line_.strike(s - 1, s, s + 1, time, outcome(law, s, time, closing(s)), Notice::none);
  }

  // Moves the origin of time to the given local time and returns its new local time. Gaps do not change.
  T move_origin(const T& local) {
    if constexpr (Line::watched)
      if (!wall_gaps_.shaken())
        wall_gaps_.with_motion(
            line_, [&](const auto& motion) { line_.certainty.begin_anew(line_.gaps, motion, first(), last()); });
    find_lost_digits(local);
    line_.gaps.move_origin(local, [this](auto&& each) {
      for (Slot s = first(); s <= last(); ++s) each(s, closing(s));
    });
    foresee_walls();
    memory_.move_origin(local);
    for (Anchor<T>* anchor : {&left_, &right_}) anchor->move_origin(local);
    return T(0);
  }

  // Lays the held gaps out anew, with free slots at either end; slots are renumbered (StreamingChain).
  void make_room() {
    std::vector<Slot> kept(last() + 1 - first());
    std::iota(kept.begin(), kept.end(), first());
    lay_out(kept, static_cast<ParticleIndex>(kept.size()));
  }

  static auto state(auto& self) {
    return fields(self.line_, self.range_, self.memory_, self.left_, self.right_, self.walls_, self.wall_gaps_);
  }

  // Checks what was loaded: whether its parts fit together and its numbers are some that gaps can have.
  void loaded() {
    find_inner();
    const ParticleIndex count = particles_->count();
    const GapRange all = particles_->gaps();
    require_state(range_.fits(slots(), count) && range_.on_ring() == particles_->on_ring(), "slots");
    const ParticleIndex first_held = all.first + range_.unheld_left();
    require_state(line_.particle_of_slot_0 == first_held - static_cast<ParticleIndex>(first()), "particles");
    require_state(on_ring() ? particle(first()) == 0 && particle(last()) + 1 == count
                            : particle(last()) == all.last - range_.unheld_right(),
                  "particles");
    require_state(line_.masses.fits(slots()) && (memory_.slots() == 0 || memory_.slots() == slots()), "lists");
    require_state(!on_ring() || (range_.front_left() == first() && range_.front_right() == last()), "seam");
    // No speed exceeds 1 + 2E/m >= sqrt(2E/m). Slots beyond the held gaps are filled again before use.
    const T fastest = particles_->walled() ? far_away<T>() : T(T(2) + T(4) * particles_->energy_over_least_mass());
    for (Slot s = first(); s <= last(); ++s) {
      const T& w = closing(s);
      require_state(fits(s) && is_finite(line_.gaps.lag(s)) && !(fastest < magnitude(w)) &&
                        line_.has_mass(s, *particles_),
                    "gaps");
    }
    for (const Slot s : {first() - 1, last() + 1}) require_state(is_finite(closing(s)), "gaps");
    if (falls()) {
      const auto pile = static_cast<std::size_t>(wall_gaps_.resting()), held = last() + 1 - first();
      require_state(pile < held || (pile == held && !wall_gaps_.pulls(particle(slot_in_pile(wall_gaps_.resting())))),
                    "pile");
      for (ParticleIndex h = 0; h < wall_gaps_.resting(); ++h)
        require_state(line_.gaps[slot_in_pile(h)].gap == T(0) && closing(slot_in_pile(h)) == T(0), "pile");
    }
    require_state(line_.has_mass(last() + 1, *particles_), "masses");
    for (const Anchor<T>* anchor : {&left_, &right_})
      require_state(on_ring() || (anchor->particle() >= all.first && anchor->particle() <= all.last + 1), "anchors");
  }

 private:
  using Ends::find_inner, Ends::is_inner, Ends::foresee_walls, Ends::widen, Ends::enter_carried, Ends::find_lost_digits;
  using Ends::line_, Ends::range_, Ends::particles_, Ends::memory_, Ends::walls_, Ends::wall_gaps_, Ends::left_;
  using Ends::right_, Ends::fastest_, Ends::slot_in_pile, Ends::flight, Ends::lay_out;

  GapChain(const std::shared_ptr<const Particles<T>>& particles, const T& start, GapRange held,
           typename Line::Gaps::Memory memory = {})
      : Ends(particles, start, held, std::move(memory)) {
    lay_out({}, held.last - held.first + 1);
    for (Slot s = first(); s <= last(); ++s) line_.load(s, *particles_, T(0));
    foresee_walls();
    if constexpr (Line::watched)
      for (Slot s = first(); s <= last(); ++s)
        if (wall_gaps_.pulls(particle(s))) wall_gaps_.watch_meeting(line_, s, T(0));
    left_.take(particle(first()));
    right_.take(particle(last()) + 1);
    for (Slot s = first(); s <= last(); ++s) fastest_ = std::max(fastest_, magnitude(closing(s)));
    if (on_ring()) range_.place_seam();
    find_inner();
  }

  // Whether a loaded gap has numbers that a gap can have.
  bool fits(Slot s) const {
    const auto& gap = line_.gaps[s];
    if (!wall_gaps_.pulls(particle(s))) return gap.fits(gap.closing);
    bool is_due = true;  // it may be due while it opens
    if constexpr (keys_are_exact) is_due = gap.due == gap.due;
    return is_due && is_finite(gap.gap) && is_finite(gap.time) && is_finite(gap.closing);
  }

  template <LawChoice Law>
  [[gnu::always_inline]] Outcome<T> outcome(const Law& law, Slot s, const T& time, const T& w) {
    return law.visit([&](const auto& own) { return outcome(own, s, time, w); });
  }
  template <class Law> [[gnu::always_inline]] Outcome<T> outcome(const Law& law, Slot s, const T& time, const T& w) {
    if constexpr (Line::watched && requires { law.cutoff(); }) watch_threshold(s, time, w, law.cutoff());
    if constexpr (LawWithMemory<Law, T>)
      if (!rested(law, s, time)) return law.elastic(w, line_.masses.of_pair(s));
    const Outcome<T> outcome = law(w, line_.masses.of_pair(s));
    if constexpr (Line::watched && !requires { law.cutoff(); })
      line_.certainty.slope(law, w, line_.masses.of_pair(s), outcome);
    return outcome;
  }
  template <LawChoice Law> Outcome<T> outcome_at_wall(const Law& law, Slot s, const T& time) {
    return law.visit([&](const auto& own) { return outcome_at_wall(own, s, time); });
  }
  template <class Law> Outcome<T> outcome_at_wall(const Law& law, Slot s, const T& time) {
    const bool after_rest = rested(law, s, time);
    if (falls()) {
      const ParticleIndex wall = walls_.beside(particle(s)) ? particle(s) : wall_gaps_.wall_of_pile();
      const T w = closing_when_due(s), &mass = line_.masses[walls_.left_of(wall) ? s + 1 : s];
      const Pair<T> elapsed = clock().since_start(time);
      if constexpr (Line::watched) {
        watch_threshold(s, time, w, wall_gaps_.rest_speed(particle(s)));
        if constexpr (requires { law.cutoff(); }) watch_threshold(s, time, w, law.cutoff());
      }
      return wall_gaps_.strike_wall(walls_, wall, law, w, mass, elapsed, wall_gaps_.holds(particle(s), w, elapsed),
                                    after_rest);
    }
    return walls_.strike(particle(s), closing(s), line_.masses[walls_.left_of(particle(s)) ? s + 1 : s]);
  }
  // Whether neither particle has had a collision within the law's contact time; records that they have one now.
  template <class Law> [[gnu::always_inline]] bool rested(const Law& law, Slot s, const T& time) {
    if constexpr (LawWithMemory<Law, T>)
      return memory_.rested({left(s), s, right(s)}, s, time, law.contact_time(), local_time(clock().start()), slots());
    return true;
  }
  // Whether rounding decides if a collision at the speed w is slower than a speed.
  void watch_threshold(Slot s, const T& time, const T& w, const T& speed) requires(Line::watched) {
    wall_gaps_.with_motion(line_, [&](const auto& motion) {
      line_.certainty.threshold(line_.gaps, motion, s, particle(s), time, w, speed);
    });
  }

  // A collision at an end of the active zone, at the seam of a ring or at a wall.
  template <class Law> [[gnu::noinline]] CollisionResult<T> collide_at_end(const Law& law, Slot s, const T& time) {
    if (falls()) return collide_falling(law, s, time);
    const Outcome<T> of_law =
        walls_.beside(particle(s)) ? outcome_at_wall(law, s, time) : outcome(law, s, time, closing(s));
    const Notice notice = on_ring() ? Notice::none : widen(s, time, of_law);
    return line_.strike(left(s), s, right(s), time, of_law, notice);
  }
  // `collide_at_end` under gravity or between shaken walls; also for collisions beside the gap to a wall, and at a
  // pile.
  template <class Law> CollisionResult<T> collide_falling(const Law& law, Slot s, const T& time) {
    const ParticleIndex resting = wall_gaps_.resting(),
                        height = wall_gaps_.piles() ? wall_gaps_.height(particle(s)) : 0;
    const bool beside_pile = wall_gaps_.piles() && height <= resting + 1;
    bool let_go = false;
    if (beside_pile && resting > 0) {
      const std::optional<T> at = wall_gaps_.pile_let_go(line_, s);
      let_go = height < resting || (at && *at < time);
    }
    const bool on_pile = !let_go && beside_pile && resting > 0 && height == resting && stays(s, time);
    const bool at_wall = walls_.beside(particle(s)) || on_pile;
    const Outcome<T> of_law = at_wall ? outcome_at_wall(law, s, time) : outcome(law, s, time, closing_when_due(s));
    const bool on_wall = beside_pile && height == 0 && of_law.closing == T(0) &&  // slow, or of a restitution 0
                         wall_gaps_.wall_presses(clock().since_start(time));
    const ParticleIndex after = let_go                                            ? ParticleIndex{on_wall}
                                : on_pile || on_wall                              ? resting + 1
                                : beside_pile && height == resting && resting > 0 ? resting - 1
                                                                                  : resting;
    for (const Slot beside : {s - 1, s, s + 1})
      if (wall_gaps_.at_wall(particle(beside)) && !(on_pile && resting == 1)) enter_carried(beside, time);
    if (let_go)
      for (ParticleIndex h = height > 1 ? 0 : 1; h < resting; ++h) enter_carried(slot_in_pile(h), time);
    else if (after < resting && resting > 1)
      enter_carried(slot_in_pile(resting - 1), time);
    const End far = wall_gaps_.pile_end() == End::left ? End::right : End::left;
    if (resting == particles_->count() && after < resting &&
        !walls_.has(far)) {  // the flight of the last one is its own again
      Anchor<T>& last_one = far == End::left ? left_ : right_;
      last_one.follow(flight(last_one, time), time, T(0));
    }
    const Notice notice = widen(s, time, of_law);
    // Of a pile that is let go, the gaps above it and below it that are not beside the collision are brought to its
    // time.
    const auto renew = [&] {
      Notice more = Notice::none;
      if (let_go)
        for (const ParticleIndex h : {resting, ParticleIndex{0}})
          if ((h + 1 < height || h > height + 1) && wall_gaps_.pulls(particle(slot_in_pile(h))))
            more |= wall_gaps_.renew(line_, slot_in_pile(h), time) | Notice::origin_must_move;  // which predicts them
      return more;
    };
    const CollisionResult<T> made = wall_gaps_.strike(line_, s - 1, s, s + 1, time, of_law, notice, after, renew);
    find_inner();
    return made;
  }

  // Whether the next particle at the wall or the pile there comes to rest on it.
  bool stays(Slot s, const T& time) const {
    return wall_gaps_.holds(particle(s), closing_when_due(s), clock().since_start(time));
  }
};

}  // namespace cradle
