#pragma once
// The world lines of a run's particles, x = place + velocity (t - origin) + a t^2/2, who is whose neighbour, and when
// two of them meet. Of incoming rows only particles that have had a collision are held, and one more on each side: the
// others fly on as they began, in order. Particles that only bounce are neighbours by their numbers; those that merge
// or pass are linked. Walls are held as lines -1 and N, which no collision changes.
//
// The origin is the start; but where a map of collisions is not linear, errors of velocities would act on places from
// there at every collision. Then it is the time of the particle's last collision, and where two meet, a time near that.
// Under gravity, of the acceleration a, lines hold places and velocities as seen by one who has fallen since the start:
// there particles fly straight. Walls do not fall, and their lines are what they are.

#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "cradle/core/certify/certain_law.hpp"
#include "cradle/core/certify/enclosing.hpp"
#include "cradle/core/initial/particles.hpp"

namespace cradle {

// A vector that grows at both ends; indices stay.
template <class T> class TwoEnded {
 public:
  ParticleIndex first() const { return first_; }
  ParticleIndex last() const { return first_ + static_cast<ParticleIndex>(used_) - 1; }
  bool empty() const { return used_ == 0; }
  T& operator[](ParticleIndex i) { return items_[from_ + static_cast<std::size_t>(i - first_)]; }
  const T& operator[](ParticleIndex i) const { return items_[from_ + static_cast<std::size_t>(i - first_)]; }

  void begin_at(ParticleIndex first) { first_ = first; }
  void push_right(T item) {
    if (from_ + used_ == items_.size()) make_room();
    items_[from_ + used_++] = std::move(item);
  }
  void push_left(T item) {
    if (from_ == 0) make_room();
    items_[--from_] = std::move(item);
    --first_, ++used_;
  }

 private:
  // A sixteenth of what is used, free on either side.
  void make_room() {
    const std::size_t room = used_ / 16 + 4;
    std::vector<T> items(used_ + 2 * room);
    for (std::size_t i = 0; i < used_; ++i) items[room + i] = std::move(items_[from_ + i]);
    items_ = std::move(items);
    from_ = room;
  }

  std::vector<T> items_;
  std::size_t from_ = 0, used_ = 0;
  ParticleIndex first_ = 0;
};

template <Enclosing N> struct WorldLine {
  N place, velocity;
  N changed{-1};  // when it had its last collision; -1: it had none
  bool touched = false;
  std::uint64_t level = 0;  // of its last collision (side_by_side.hpp)
};

template <Enclosing N> class WorldLines {
 public:
  using Line = WorldLine<N>;
  static constexpr ParticleIndex none = -1;

  WorldLines(std::shared_ptr<const Particles<N>> particles, bool linked)
      : particles_(std::move(particles)), linked_(linked), identical_(particles_->identical_masses()) {
    const GapRange moving = particles_->gaps_in_motion();
    const ParticleIndex first = moving.last < moving.first ? 0 : moving.first;
    const ParticleIndex last = on_ring() || moving.last < moving.first ? count() - 1 : moving.last + 1;
    lines_.begin_at(first);
    links_.begin_at(first);
    for (ParticleIndex b = first; b <= last; ++b) take_in_right(b);
    if (on_ring()) {
      seam_ = count() - 1;
      if (linked_) links_[seam_].right = 0, links_[0].left = seam_;
    }
  }

  const Particles<N>& particles() const { return *particles_; }
  ParticleIndex count() const { return particles_->count(); }
  bool on_ring() const { return particles_->on_ring(); }
  bool identical_masses() const { return identical_ && !linked_; }
  ParticleIndex first() const { return lines_.first(); }
  ParticleIndex last() const { return lines_.last(); }

  // The particle or cluster that goes by the number of one of its particles; that must be held.
  ParticleIndex cluster(ParticleIndex b) {
    if (!linked_) return b;
    while (links_[b].part_of != b) b = links_[b].part_of = links_[links_[b].part_of].part_of;
    return b;
  }
  ParticleIndex cluster(ParticleIndex b) const {
    while (linked_ && links_[b].part_of != b) b = links_[b].part_of;
    return b;
  }
  bool is_cluster(ParticleIndex b) const { return !linked_ || links_[b].part_of == b; }
  bool is_wall(ParticleIndex b) const { return b < 0 || b >= count(); }
  bool holds(ParticleIndex b) const { return b >= first() && b <= last(); }
  Line& operator[](ParticleIndex b) { return lines_[b]; }
  const Line& operator[](ParticleIndex b) const { return lines_[b]; }
  N mass(ParticleIndex b) const { return linked_ ? links_[b].mass : particles_->mass(b); }

  // The next one to the right; none at the end of what is held. On a ring the seam lies between seam() and the next:
  // what is right of it is a circumference further on than its place says.
  ParticleIndex right(ParticleIndex b) const {
    if (linked_) return links_[b].right;
    return b < last() ? b + 1 : on_ring() ? 0 : none;
  }
  ParticleIndex left(ParticleIndex b) const {
    if (linked_) return links_[b].left;
    return b > first() ? b - 1 : on_ring() ? last() : none;
  }
  ParticleIndex seam() const { return seam_; }

  // Whether they are neighbours, for sure, and reach() takes in none beside them.
  bool inside(ParticleIndex left, ParticleIndex right) const {
    return right == left + 1 && left > first() && right < last() && !linked_;
  }
  // Takes in the particles of a row beside one that is about to have its first collision.
  void reach(ParticleIndex left, ParticleIndex right) {
    if (left == first() && left > 0) take_in_left(left - 1);
    if (right == last() && right + 1 < count()) take_in_right(right + 1);
  }

  // l and the one on its right are one from now on, called l.
  void merge(ParticleIndex l, ParticleIndex r) {
    links_[l].mass += links_[r].mass;
    links_[r].part_of = l;
    link(l, links_[r].right == l ? l : links_[r].right);
    if (seam_ == r) seam_ = l;
  }
  // They change places; the seam stays where it is in the line.
  void pass(ParticleIndex l, ParticleIndex r) {
    const ParticleIndex before = links_[l].left, after = links_[r].right;
    seam_ = seam_ == l ? r : seam_ == r ? l : seam_;
    link(r, l);
    if (before == r) return link(l, r);  // two of them on a ring
    link(before, r);
    link(l, after);
  }

 private:
  struct Links {
    N mass;
    ParticleIndex left = none, right = none, part_of = none;
  };

  Line line_of(ParticleIndex b) const {
    Line line{particles_->position(b), particles_->velocity(b)};
    // Nothing is later: its collisions are left out where many are computed side by side.
    if (is_wall(b)) line.changed = N(std::numeric_limits<double>::infinity());
    return line;
  }
  void take_in_right(ParticleIndex b) {
    const bool alone = lines_.empty();
    lines_.push_right(line_of(b));
    if (!linked_) return;
    links_.push_right({particles_->mass(b), none, none, b});
    if (!alone) link(b - 1, b);
  }
  void take_in_left(ParticleIndex b) {
    lines_.push_left(line_of(b));
    if (!linked_) return;
    links_.push_left({particles_->mass(b), none, none, b});
    link(b, b + 1);
  }
  void link(ParticleIndex l, ParticleIndex r) {
    if (l != none) links_[l].right = r;
    if (r != none) links_[r].left = l;
  }

  std::shared_ptr<const Particles<N>> particles_;
  bool linked_, identical_;
  TwoEnded<Line> lines_;
  TwoEnded<Links> links_;
  ParticleIndex seam_ = none;
};

template <Enclosing N> struct Motion {
  using Line = WorldLine<N>;

  Motion(std::shared_ptr<const Particles<N>> particles, const CertainLaw<N>& law)
      : lines(std::move(particles), !law.bounces_only()), length(lines.particles().circumference()),
        acceleration(lines.particles().acceleration()), falls(lines.particles().fall()),
        of_collisions(!law.linear() || (falls && lines.particles().walled())) {}

  [[gnu::always_inline]] N place_at(ParticleIndex b, const N& time) const {
    const Line& line = lines[b];
    const N flown = line.place + line.velocity * (of_collisions ? time - origin(line) : time);
    if (!falls || lines.is_wall(b)) return flown;
    return flown + fallen(time);
  }
  N velocity_at(ParticleIndex b, const N& time) const {
    if (!falls || lines.is_wall(b)) return lines[b].velocity;
    return lines[b].velocity + acceleration * time;
  }
  N fallen(const N& time) const { return acceleration * (time * time) / N(2); }

  // Places of both at one time, in the image of the one on the right.
  struct Places {
    N left, right, time{0};
  };
  Places places_of(const Line& l, const Line& r, const N& closing, bool over_seam) const {
    Places at{l.place, r.place};
    if (over_seam) at.left -= length;
    if (!of_collisions) return at;
    const N &of_l = origin(l), &of_r = origin(r);
    const N then = to_double(of_l) < to_double(of_r) ? of_r : of_l;
    at.left += l.velocity * (then - of_l), at.right += r.velocity * (then - of_r);
    const N near = N((then - (at.left - at.right) / closing).middle(), 0), on = near - then;
    return {at.left + l.velocity * on, at.right + r.velocity * on, near};
  }
  // The time that a line's place is of.
  N origin(const Line& line) const { return of_collisions && line.touched ? N(line.changed.middle(), 0) : zero; }

  Order compare(const N& x, const N& y) const {
    const Order order = order_in_doubles(x, y);
    if (order != Order::open) return order;
    needed_balls = true;
    return order_in_balls(x, y);
  }

  WorldLines<N> lines;
  N length, acceleration, zero{0};
  bool falls, of_collisions;
  mutable bool needed_balls = false;  // since it was reset: plain doubles did not decide
};

}  // namespace cradle
