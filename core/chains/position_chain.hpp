#pragma once
// The chain in absolute positions and velocities, as in conventional event-driven programs: every particle has a
// position, a velocity and the time of its last collision, and differences of positions in absolute time give the next
// collision of neighbours. README.md (PositionChain) says what it is for. In a collapsing core its differences lose
// their digits, which it counts.
// Under gravity particles fly along parabolas; shaken walls are where their motion says.

#include <algorithm>
#include <memory>
#include <vector>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/anchor.hpp"
#include "cradle/core/chains/chain.hpp"
#include "cradle/core/laws/one_of.hpp"
#include "cradle/core/queue/ledger.hpp"
#include "cradle/core/queue/relative_motion.hpp"

namespace cradle {

template <Real T> class PositionChain {
 public:
  using Scalar = T;
  static constexpr bool keys_are_exact = false;
  static constexpr bool may_collapse = true;

  // Throws std::invalid_argument for particles on a ring or without order in the working precision, and for walls that
  // hold particles.
  PositionChain(std::shared_ptr<const Particles<T>> particles, const T& start)
      : start_(start), origin_(start), first_particle_(particles->gaps().first), walls_(particles->walls()),
        of_walls_(particles), field_(*particles), lost_(particles->energy_to_lose()) {
    require_particles(*particles, start);
    if (std::numeric_limits<T>::is_exact) require_no_gravity(*particles, "use a type that has square roots");
    require(!particles->on_ring(), "a ring in absolute positions (circumference ", particles->circumference(),
            "): use a chain in gaps");
    for (ParticleIndex b = first_particle_; b <= particles->gaps().last + 1; ++b)
      particles_.push_back({particles->position(b), particles->velocity(b), start, particles->mass(b)});
    for (Slot s = first(); s <= last(); ++s)
      require(at(s).x < at(s + 1).x, "particles ", particle(s), " and ", particle(s) + 1,
              " have the same place in absolute positions (", at(s).x, "): use a chain in gaps, or more digits");
    if (const Wall<T>* wall = particles->holding())
      require(false, "a particle that rests on a wall in absolute positions (rest speed ", wall->rest_speed,
              "): use a chain in gaps");
    due_.assign(slots(), T(0));
    closing_.assign(slots(), T(0));
    for (Slot s = first(); s <= last(); ++s) predict(s, start);
  }

  // ---- times: absolute; only the queue's keys count from an origin that moves
  T local_time(const T& time) const { return time; }
  double queue_time(const T& time) const { return to_double(T(time - origin_)); }
  const T& start() const { return start_; }
  Pair<T> stamp(const T& time) const { return {time, T(0)}; }

  // ---- slots: two empty ones at either end
  std::size_t slots() const { return particles_.size() + 3; }
  Slot first() const { return 2; }
  Slot last() const { return particles_.size(); }
  Slot left(Slot s) const { return s - 1; }
  Slot right(Slot s) const { return s + 1; }
  bool on_ring() const { return false; }
  ParticleIndex particle(Slot s) const { return static_cast<ParticleIndex>(s) - 2 + first_particle_; }
  Slot slot_of(ParticleIndex particle) const { return static_cast<Slot>(particle - first_particle_ + 2); }
  ParticleIndex count() const { return of_walls_->count(); }
  ParticleIndex collided_particles() const {
    return front_right_ < front_left_ ? 0 : static_cast<ParticleIndex>(outermost_right() - outermost_left() + 1);
  }

  const T& due(Slot s) const { return due_[s]; }
  // A particle at rest on a floor meets it at once, at the speed 0.
  double queue_due(Slot s) const {
    const bool meets = closing_[s] > T(0) || (closing_[s] == T(0) && field_.pulls(particle(s)));
    return meets ? queue_time(due_[s]) : EventQueue::never;
  }

  // At the next collision; of a gap to a wall under gravity without one, negative.
  const T& closing(Slot s) const { return closing_[s]; }

  template <class Law> CollisionResult<T> collide(const Law& law, Slot s, const T& time) requires(Law::bounces_only) {
    Particle &left = at(s), &right = at(s + 1);
    const bool at_wall = walls_.beside(particle(s));
    const Outcome<T> outcome = with_law(law, [&](const auto& own) {
      if (at_wall) return strike_wall(own, s, time);
      return left.m == right.m ? outcome_of(own, s, time, EqualMasses<T>{left.m, T(left.m / T(2))})
                               : outcome_of(own, s, time, TwoMasses<T>{left.m, right.m});
    });
    advance(s, time);
    advance(s + 1, time);
    walls_.right_of(particle(s)) ? left.x = right.x : right.x = left.x;
    left.v -= outcome.to_left;
    right.v += outcome.to_right;
    if (at_wall && falls()) leave_wall(s, outcome.closing);
    front_left_ = std::min(front_left_, s);
    front_right_ = std::max(front_right_, s);

    Notice notice = Notice::none;
    predict(s, time);
    if (s > first()) notice |= resolve(s - 1, time);
    if (s < last()) notice |= resolve(s + 1, time);
    if (const auto back = rebound(s); back && back->height < floor_) notice |= Notice::gap_below_floor;
    return {outcome, queue_due(s - 1), queue_due(s), queue_due(s + 1), notice, s - 1, s + 1};
  }

  T move_origin(const T& local) { return origin_ = local; }

  void set_floor(const T& floor) { floor_ = floor; }
  T nearest_gap(Slot s) const {
    const T far = far_away<T>();
    const T time = at(s).time;
    const T on_left = s > first() ? gap_at(s - 1, time) : far, on_right = s < last() ? gap_at(s + 1, time) : far;
    return on_left < on_right ? on_left : on_right;
  }
  std::optional<Rebound<T>> rebound(Slot s) const {
    const T& time = at(s).time;
    return field_.rebound(particle(s), T(velocity(s, time) - velocity(s + 1, time)), since_start(time));
  }
  bool falls() const { return field_.anywhere(); }
  const Account<T>& account() const { return account_; }
  void lose(Slot, const T& energy) { lost_.add(energy); }
  T energy_lost() const { return lost_.value(); }
  // The smallest difference between two collision times that is resolved: the rounding of a position divided by the
  // closing speed, which is large for a slow pair.
  T time_resolution(Slot s, const T& time) const {
    const T slowest = magnitude(closing_[s]);
    const T way = T(std::numeric_limits<T>::epsilon()) * (magnitude(at(s).x) + magnitude(time * at(s).v));
    return T(std::numeric_limits<T>::epsilon()) * magnitude(time) +
           (is_positive(slowest) ? T(T(8) * way / slowest) : way);
  }

  template <class Law> std::optional<Outcome<T>> at_unit_speed(const Law& law, Slot s) const {
    if (walls_.beside(particle(s)))
      return walls_.at_unit_speed(particle(s), at(walls_.left_of(particle(s)) ? s + 1 : s).m);
    return law(T(1), TwoMasses<T>{at(s).m, at(s + 1).m});
  }
  const Particles<T>& particles() const { return *of_walls_; }

  static auto state(auto& self) {
    return fields(self.particles_, self.due_, self.closing_, self.floor_, self.origin_, self.front_left_,
                  self.front_right_, self.account_, self.lost_, self.walls_);
  }
  void loaded() const {
    const ParticleIndex all = count() + (walls_.has(End::left) ? 1 : 0) + (walls_.has(End::right) ? 1 : 0);
    require_state(particles_.size() == static_cast<std::size_t>(all) && due_.size() == slots() &&
                      closing_.size() == slots(),
                  "lists");
    const bool none = front_left_ == std::numeric_limits<Slot>::max() && front_right_ == 0;
    require_state(none || (front_left_ >= first() && front_left_ <= front_right_ && front_right_ <= last()), "fronts");
    bool right = is_finite(origin_);
    for (const Particle& p : particles_) right = right && p.holds_numbers();
    for (Slot s = 0; s < slots(); ++s)  // without a gap none closes; collisions may be beyond the range
      right = right && due_[s] == due_[s] && is_finite(closing_[s]) &&
              !(is_positive(closing_[s]) && (s < first() || s > last()));
    require_state(right, "numbers");
  }

  T gap_at(Slot s, const T& time) const { return place(s + 1, time) - place(s, time); }
  T front_left(const T& time) const { return place(outermost_left(), time); }
  T front_right(const T& time) const { return place(outermost_right(), time); }
  const Walls<T>& walls() const { return walls_; }
  // Of all particles. Between walls their momentum is not conserved.
  T kinetic_energy(const T& time) const {
    const T total = of_walls_->total_mass();
    T drift = of_walls_->conserved_momentum() / total;
    if (falls()) drift += field_.acceleration() * (time - start_);
    const auto moving = relative_motion(total, walls_.any() ? T(0) : drift, [&](const T& c, const auto& add) {
      for (Slot s = slot_of(0); s < slot_of(count()); ++s) add(at(s).m, T(velocity(s, time) - c));
    });
    const T speed = walls_.any() ? moving.mean : drift;
    return total * speed * speed / T(2) + moving.energy;
  }

  Configuration<T> configuration(const T& time) const {
    const bool collided = front_left_ <= front_right_;
    const Slot from = collided && front_left_ > first() ? front_left_ - 1 : first();
    const Slot to = collided && front_right_ < last() ? front_right_ + 1 : last();
    Configuration<T> c;
    c.time = time;
    c.from = particle(from);
    c.to = particle(to) + 1;
    if (front_left_ <= front_right_) c.collided_from = front_left_ - from, c.collided_to = front_right_ - from + 2;
    for (Slot s = from; s <= to + 1; ++s) {
      c.index.push_back(particle(s));
      c.m.push_back(at(s).m);
      c.x.push_back(place(s, time));
      c.v.push_back(velocity(s, time));
    }
    for (Slot s = from; s <= to; ++s) {
      c.gap.push_back(gap_at(s, time));
      c.closing_speed.push_back(velocity(s, time) - velocity(s + 1, time));
    }
    leave_out_walls(c, count());
    return c;
  }

 private:
  struct Particle {
    T x, v, time, m;  // time: of the last collision, or the start
    bool collided = false;
    static auto state(auto& self) { return fields(self.x, self.v, self.time, self.m, self.collided); }
    bool holds_numbers() const { return is_finite(x) && is_finite(v) && is_finite(time) && is_positive(m); }
    bool rested(const T& now, const T& contact_time) const { return !collided || !(now - time < contact_time); }
  };

  template <class Law> Outcome<T> strike_wall(const Law& law, Slot s, const T& time) {
    const Particle& struck = at(walls_.left_of(particle(s)) ? s + 1 : s);
    if (!falls()) return walls_.strike(particle(s), closing_[s], struck.m);
    bool rested = true;
    if constexpr (LawWithMemory<Law, T>) rested = struck.rested(time, law.contact_time());
    return field_.strike_wall(walls_, particle(s), law, closing_[s], struck.m, since_start(time), false, rested);
  }
  template <class Law, class Masses>
  Outcome<T> outcome_of(const Law& law, Slot s, const T& time, const Masses& masses) const {
    if constexpr (LawWithMemory<Law, T>)
      if (!at(s).rested(time, law.contact_time()) || !at(s + 1).rested(time, law.contact_time()))
        return law.elastic(closing_[s], masses);
    return law(closing_[s], masses);
  }

  // Slots of which the left particle is the outermost one that has collided; walls are not counted.
  Slot outermost_left() const { return front_left_ + (walls_.left_of(particle(front_left_)) ? 1 : 0); }
  Slot outermost_right() const { return front_right_ + (walls_.right_of(particle(front_right_)) ? 0 : 1); }

  Pair<T> since_start(const T& time) const { return two_sum(time, T(-start_)); }
  Particle& at(Slot s) { return particles_[s - 2]; }  // the particle on the left of a gap
  const Particle& at(Slot s) const { return particles_[s - 2]; }

  T fall(Slot s) const { return s >= slot_of(0) && s < slot_of(count()) ? field_.acceleration() : T(0); }
  T place(Slot s, const T& time) const {
    const Particle& p = at(s);
    const T flown = time - p.time;
    if (of_walls_->shaken(particle(s))) return at_wall(*of_walls_, particle(s), since_start(time)).x.value();
    return p.x + (falls() ? T(p.v + fall(s) * flown / T(2)) : p.v) * flown;
  }
  T velocity(Slot s, const T& time) const {
    if (of_walls_->shaken(particle(s))) return at_wall(*of_walls_, particle(s), since_start(time)).v.value();
    return falls() ? T(at(s).v + fall(s) * (time - at(s).time)) : at(s).v;
  }
  void advance(Slot s, const T& time) { at(s) = {place(s, time), velocity(s, time), time, at(s).m, true}; }

  // Where flights are shorter than times resolve, the particle has not fallen to the wall by the time of the collision:
  // it leaves at the speed of the outcome, not by the impulse.
  void leave_wall(Slot s, const T& closing) {
    const bool left = walls_.left_of(particle(s));
    at(left ? s + 1 : s).v = left ? T(at(s).v - closing) : T(at(s + 1).v + closing);
  }

  void predict(Slot s, const T& now) {
    closing_[s] = velocity(s, now) - velocity(s + 1, now);
    if (field_.pulls(particle(s))) {
      const WallApproach<T> approach = field_.approach(particle(s), gap_at(s, now), closing_[s], since_start(now));
      const auto meeting = approach.meeting();
      closing_[s] = meeting ? meeting->speed : T(-1);
      due_[s] = meeting ? T(now + meeting->in) : T(0);
      return;
    }
    due_[s] = closing_[s] > T(0) ? T(now + gap_at(s, now) / closing_[s]) : T(0);
  }

  // Predicts the next collision of a gap beside one that has just closed, and checks whether positions still resolve
  // it.
  Notice resolve(Slot s, const T& time) {
    predict(s, time);
    const T gap = gap_at(s, time), epsilon = std::numeric_limits<T>::epsilon();
    const T unit = epsilon * std::max<T>(magnitude(at(s).x), magnitude(at(s + 1).x));
    const T rounding =
        T(16) * (unit + epsilon * magnitude(time) * (magnitude(velocity(s, time)) + magnitude(velocity(s + 1, time))));
    if (gap < unit * T(1000000) && account_.unresolved++ == 0) account_.first_unresolved = {time, particle(s), gap};
    if (!(gap > T(0))) account_.enter({time, particle(s), gap}, rounding);
    return gap < floor_ ? Notice::gap_below_floor : Notice::none;
  }

  std::vector<Particle> particles_;  // and walls
  std::vector<T> due_, closing_;
  T floor_{0};
  T start_, origin_;
  ParticleIndex first_particle_;
  Walls<T> walls_;
  std::shared_ptr<const Particles<T>> of_walls_;
  Slot front_left_ = std::numeric_limits<Slot>::max(), front_right_ = 0;
  Account<T> account_;
  Gravity<T> field_;
  Ledger<T> lost_;
};

}  // namespace cradle
