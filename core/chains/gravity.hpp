#pragma once
// Gravity and shaken walls as a chain sees them: a pull on the gaps to walls, or a motion of these walls, and nothing
// else (laws/wall_approach.hpp). Without either no gap is pulled.
//
// Particles that rest on a wall are a pile: the gaps in it are 0 and closed, the gap above it is as one to the wall.
// Which gap that is follows from how many there are, in particles from the wall (gap_chain.hpp). A single particle
// that rests is a pile where there is another wall, too: the gap to that wall then does not close by gravity.

#include "cradle/core/base/fields.hpp"
#include "cradle/core/initial/particles.hpp"
#include "cradle/core/laws/wall_approach.hpp"

namespace cradle {

// A flight that ends on the wall where it begins: the speed at which a particle leaves it, and how far it gets,
// w^2/(2 p), of a shaken wall with its acceleration then, p + s''. On an inelastic floor the heights shrink by a
// constant factor per collision, as gaps do in other collapses.
template <Real T> struct Rebound { T speed, height; };

// Whether a collision with a wall under gravity, or where a wall is shaken, is below the law's cut-off. On an inelastic
// floor particles collapse without any others, so collisions with walls below the cut-off are elastic too. This holds
// also if the cut-off sets in slowly among particles: if it set in as slowly at the floor, a particle would come to
// rest there only after exponentially many collisions.
template <Real T, class Law> bool below_cutoff(const Law& law, const T& w) {
  if constexpr (requires { law.below_cutoff(w); })
    return law.below_cutoff(w);
  else if constexpr (requires { law.cutoff(); })
    return w < law.cutoff();
  else
    return false;
}

template <Real T> class Gravity {
 public:
  explicit Gravity(const Particles<T>& particles)
      : acceleration_(particles.acceleration()), left_(end(particles, End::left)), right_(end(particles, End::right)),
        holds_(particles.holding() != nullptr),
        piles_(holds_ && (particles.count() > 1 || (particles.wall(End::left) && particles.wall(End::right)))),
        pile_end_(piles_ && particles.holding() == particles.wall(End::right) ? End::right : End::left),
        anywhere_(acceleration_ != T(0) || shaken()), gaps_(particles.gaps()), count_(particles.count()) {
    if (anywhere_) splitter_ = splitter<T>();
    const bool left = pile_end_ == End::left;
    if (particles.wall(left ? End::right : End::left) != nullptr) other_wall_ = left ? gaps_.last : gaps_.first;
  }

  const T& acceleration() const { return acceleration_; }
  // Whether this is a gap to a wall, or above a pile, that does not close uniformly.
  bool pulls(ParticleIndex gap) const { return anywhere_ && (at_wall(gap) || gap == above_pile_); }
  bool at_wall(ParticleIndex gap) const { return gap == left_.gap || gap == right_.gap; }

  bool anywhere() const { return anywhere_; }
  // Whether a wall is shaken, and whether a particle may miss the wall at a gap, or one of its jumps.
  bool shaken() const { return left_.wall.motion != nullptr || right_.wall.motion != nullptr; }
  bool may_miss(ParticleIndex gap) const {
    return shaken() || !is_positive(pull(end_below(gap))) || gap == other_wall_;
  }
  // The speed below which particles stay at the wall of a gap, or on the pile there; 0 if none do.
  T rest_speed(ParticleIndex gap) const {
    const AtEnd& end = at(end_below(gap));
    return end.wall.holds ? end.rest_speed : T(0);
  }

  // Whether a wall has all particles on it, or the single one that it can hold.
  bool holds_all() const { return resting_ == count_ || (holds_ && count_ == 1); }
  // Whether particles can be a pile, at which end, and how many are in it; a gap there, counted from the wall.
  bool piles() const { return piles_; }
  End pile_end() const { return pile_end_; }
  ParticleIndex resting() const { return resting_; }
  ParticleIndex wall_of_pile() const { return pile_end_ == End::left ? gaps_.first : gaps_.last; }
  ParticleIndex height(ParticleIndex gap) const {
    return pile_end_ == End::left ? gap - gaps_.first : gaps_.last - gap;
  }
  void rest(ParticleIndex particles) {
    resting_ = particles;
    const ParticleIndex gap = pile_end_ == End::left ? gaps_.first + particles : gaps_.last - particles;
    above_pile_ = particles > 0 && gaps_.first <= gap && gap <= gaps_.last ? gap : none;
  }
  bool above_pile(ParticleIndex gap) const { return gap == above_pile_; }
  // The approach of the gap above the pile, which the wall holds for the time `held` (nothing: for ever).
  WallApproach<T> approach_pile(const T& size, const T& closing, const Pair<T>& since,
                                const std::optional<T>& held) const {
    const WallMotion<T>*motion = at(pile_end_).wall.motion,
          *other = at(pile_end_ == End::left ? End::right : End::left).wall.motion;
    if (above_pile_ != other_wall_) return {size, closing, pull(pile_end_), splitter_, motion, since, held, T(0)};
    // Between the pile and the other wall; only one of the two is shaken.
    return {size, closing, T(0), splitter_, motion != nullptr ? motion : other, since, held, T(-pull(pile_end_))};
  }
  // The approach of a gap that it pulls; `since` is a time since the start.
  WallApproach<T> approach(ParticleIndex gap, const T& size, const T& closing, const Pair<T>& since) const {
    const End end = end_at(gap);  // where several can rest, one comes to rest in a collision only
    return {size, closing, pull(end), splitter_, at(end).wall, since, !piles_ || resting_ > 0};
  }
  // Whether a particle that meets the wall, or the pile on it, at this speed stays there.
  bool holds(ParticleIndex gap, const T& speed, const Pair<T>& elapsed) const {
    const bool on_pile = gap == above_pile_ && gap != other_wall_;
    const End end = on_pile ? pile_end_ : end_at(gap);
    const auto& [own_gap, wall, rest_speed] = at(end);
    return (on_pile || own_gap == gap) && wall.holds && speed < rest_speed && wall.presses(pull(end), elapsed);
  }
  // Whether the wall at the end of the pile holds what has come to rest there.
  bool wall_presses(const Pair<T>& elapsed) const { return at(pile_end_).wall.presses(pull(pile_end_), elapsed); }
  // What follows a collision at a wall, if the wall presses the particle and does not hold it.
  std::optional<Rebound<T>> rebound(ParticleIndex gap, const T& closing, const Pair<T>& elapsed) const {
    if (!at_wall(gap)) return {};
    const HoldingWall<T>& wall = at(end_at(gap)).wall;
    const T press = wall.pressure(pull(end_at(gap)), elapsed);
    if (!is_positive(press) || (wall.holds && closing == T(0))) return {};
    return Rebound<T>{magnitude(closing), T(closing * closing / (press + press))};
  }
  // The speed towards the particles at which the wall at a gap is shaken.
  T shaken_at(ParticleIndex gap, const Pair<T>& elapsed) const {
    if (!at_wall(gap)) return T(0);
    const HoldingWall<T>& wall = at(end_at(gap)).wall;
    return wall.motion != nullptr ? wall.at(elapsed).wall.speed : T(0);
  }

  // What comes of a collision at the speed w with a wall, which is at the end of the gap; elastic below the law's
  // cut-off.
  template <class Law>
  Outcome<T> strike_wall(Walls<T>& walls, ParticleIndex gap, const Law& law, const T& w, const T& mass,
                         const Pair<T>& elapsed, bool stays = false, bool rested = true) const {
    const bool elastic = !stays && (!rested || below_cutoff(law, w));
    const T restitution = stays ? T(0) : elastic ? T(1) : walls.wall(gap).restitution;
    Outcome<T> outcome = walls.strike(gap, w, mass, restitution, shaken_at(gap, elapsed));
    outcome.below_cutoff = elastic && walls.wall(gap).reflects();
    return outcome;
  }

  static auto state(auto& self) { return fields(self.resting_); }
  void loaded() {
    require_state(resting_ >= 0 && resting_ <= (piles_ ? count_ : 0), "pile");
    rest(resting_);
  }

 private:
  static constexpr ParticleIndex none = std::numeric_limits<ParticleIndex>::min();
  struct AtEnd {
    ParticleIndex gap = none;
    HoldingWall<T> wall = {};
    T rest_speed{0};
  };
  static AtEnd end(const Particles<T>& particles, End end) {
    const Wall<T>* wall = particles.wall(end);
    if (wall == nullptr || !(particles.fall() || wall->motion != nullptr)) return {};
    const T pull = end == End::left ? T(-particles.acceleration()) : particles.acceleration();
    const WallMotion<T>* motion = wall->motion.get();
    return {end == End::left ? -1 : particles.count() - 1,
            {motion, wall->holds(), motion != nullptr ? motion->release(pull) : std::nullopt, {}},
            wall->rest_speed};
  }

  const AtEnd& at(End end) const { return end == End::left ? left_ : right_; }
  // The end at which a gap to a wall is, and the one on whose wall particles rest at this gap, also on a pile.
  End end_at(ParticleIndex gap) const { return gap == left_.gap ? End::left : End::right; }
  End end_below(ParticleIndex gap) const { return gap == above_pile_ ? pile_end_ : end_at(gap); }
  T pull(End end) const { return end == End::left ? T(-acceleration_) : acceleration_; }

  T acceleration_, splitter_{0};
  AtEnd left_, right_;
  bool holds_, piles_;
  End pile_end_;
  bool anywhere_;
  GapRange gaps_;
  ParticleIndex count_, other_wall_ = none, resting_ = 0, above_pile_ = none;
};

}  // namespace cradle
