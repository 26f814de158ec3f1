#pragma once
// Conventional event-driven programs, in double. All but the last hold equal particles on a line that follow the
// inelastic law with a velocity cut-off.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "cradle/core/initial/particles.hpp"

namespace twins {

inline constexpr double never = std::numeric_limits<double>::infinity();

struct Law {
  double restitution;
  double cutoff;  // closing speed below which collisions are elastic
};

// That flies freely: x is the position at `time`.
struct Flying {
  double x, v, time;
  double at(double t) const { return x + v * (t - time); }
  void advance(double t) {
    x = at(t);
    time = t;
  }
};

// Absolute positions and velocities; a particle is advanced only when it collides.
class Line {
 public:
  Line(const cradle::Particles<double>& particles, Law law) : law_(law) {
    particles_.reserve(static_cast<std::size_t>(particles.count()));
    for (cradle::ParticleIndex b = 0; b < particles.count(); ++b)
      particles_.push_back({particles.position(b), particles.velocity(b), 0});
  }

  std::size_t gaps() const { return particles_.size() - 1; }

  // Time of the next collision of particles i and i + 1, predicted at the time `now`.
  double due(std::size_t i, double now) const {
    const Flying &left = particles_[i], &right = particles_[i + 1];
    const double closing = left.v - right.v;
    if (!(closing > 0)) return never;
    return now + std::max(right.at(now) - left.at(now), 0.0) / closing;  // rounding can make the gap negative
  }

  std::vector<double> all_due() const {
    std::vector<double> times(gaps());
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = due(i, 0);
    return times;
  }

  // Collision of particles i and i + 1.
  void collide(std::size_t i, double time) {
    Flying &left = particles_[i], &right = particles_[i + 1];
    left.advance(time);
    right.advance(time);
    right.x = left.x;
    const double closing = left.v - right.v;
    const double impulse = (1 + (closing < law_.cutoff ? 1 : law_.restitution)) / 2 * closing;
    left.v -= impulse;
    right.v += impulse;
  }

 private:
  Law law_;
  std::vector<Flying> particles_;
};

// ---- queues of predicted collisions
//
// The better ones are a binary heap with one entry per gap. It knows the place of each gap's entry, so a new prediction
// replaces the old one in place (increase or decrease key). There are no stale events, and the heap never grows.

struct Event {
  double time;
  std::uint32_t gap;
};

// No queue: all times are compared.
class Scan {
 public:
  explicit Scan(std::vector<double> due) : due_(std::move(due)) {}
  Event first() const {
    const auto least = std::min_element(due_.begin(), due_.end());
    return {*least, static_cast<std::uint32_t>(least - due_.begin())};
  }
  void update(std::uint32_t gap, double time) { due_[gap] = time; }

 private:
  std::vector<double> due_;
};

// The layout is that of textbooks: gaps in heap order, the place of each gap, the key of each gap.
class IndexedHeap {
 public:
  explicit IndexedHeap(std::vector<double> due) : heap_(due.size()), place_(due.size()), due_(std::move(due)) {
    const auto size = static_cast<std::uint32_t>(heap_.size());
    for (std::uint32_t i = 0; i < size; ++i) heap_[i] = place_[i] = i;
    for (std::uint32_t p = size / 2; p-- > 0;) sink(p);
  }

  Event first() const { return {due_[heap_[0]], heap_[0]}; }

  void update(std::uint32_t gap, double time) {
    const bool sooner = time < due_[gap];
    due_[gap] = time;
    if (sooner)
      rise(place_[gap]);
    else
      sink(place_[gap]);
  }

 private:
  void rise(std::uint32_t p) {
    for (; p > 0 && before(p, (p - 1) / 2); p = (p - 1) / 2) exchange(p, (p - 1) / 2);
  }

  void sink(std::uint32_t p) {
    const auto size = static_cast<std::uint32_t>(heap_.size());
    for (std::uint32_t child; (child = 2 * p + 1) < size; p = child) {
      if (child + 1 < size && before(child + 1, child)) ++child;
      if (!before(child, p)) break;
      exchange(p, child);
    }
  }

  bool before(std::uint32_t p, std::uint32_t q) const { return due_[heap_[p]] < due_[heap_[q]]; }
  void exchange(std::uint32_t p, std::uint32_t q) {
    std::swap(heap_[p], heap_[q]);
    place_[heap_[p]] = p;
    place_[heap_[q]] = q;
  }

  std::vector<std::uint32_t> heap_;   // gaps
  std::vector<std::uint32_t> place_;  // of each gap in the heap
  std::vector<double> due_;           // of each gap
};

// A faster form: entries contain their times, so that comparing two needs no look-up, and an entry that moves up or
// down leaves a hole instead of being exchanged at every level.
class TunedHeap {
 public:
  explicit TunedHeap(const std::vector<double>& due) : heap_(due.size()), place_(due.size()) {
    for (std::uint32_t i = 0; i < heap_.size(); ++i) heap_[i] = {due[i], i};
    std::make_heap(heap_.begin(), heap_.end(), [](const Event& a, const Event& b) { return a.time > b.time; });
    for (std::uint32_t p = 0; p < heap_.size(); ++p) place_[heap_[p].gap] = p;
  }

  const Event& first() const { return heap_.front(); }

  void update(std::uint32_t gap, double time) {
    const std::uint32_t p = place_[gap];
    if (time < heap_[p].time)
      rise(p, {time, gap});
    else
      sink(p, {time, gap});
  }

 private:
  void rise(std::uint32_t p, Event event) {
    while (p > 0 && event.time < heap_[(p - 1) / 2].time) {
      put(p, heap_[(p - 1) / 2]);
      p = (p - 1) / 2;
    }
    put(p, event);
  }

  void sink(std::uint32_t p, Event event) {
    const auto size = static_cast<std::uint32_t>(heap_.size());
    for (std::uint32_t child; (child = 2 * p + 1) < size; p = child) {
      if (child + 1 < size && heap_[child + 1].time < heap_[child].time) ++child;
      if (!(heap_[child].time < event.time)) break;
      put(p, heap_[child]);
    }
    put(p, event);
  }

  void put(std::uint32_t p, const Event& event) {
    heap_[p] = event;
    place_[event.gap] = p;
  }

  std::vector<Event> heap_;
  std::vector<std::uint32_t> place_;  // of each gap's entry in the heap
};

template <class Queue> class QueueEngine {
 public:
  QueueEngine(const cradle::Particles<double>& particles, Law law) : line_(particles, law), queue_(line_.all_due()) {}

  // Makes every collision at times <= until.
  void advance(double until);

  std::uint64_t collisions() const { return collisions_; }

 private:
  Line line_;
  Queue queue_;
  std::uint64_t collisions_ = 0;
};

// ---- time slots

// The best of the conventional engines: neighbours as gaps, as in Cradle, and a flat table of time slots for the next
// collisions. Each slot is a list that is searched from end to end (a calendar queue; R. Brown 1988, doi
// 10.1145/63039.63045). A slot holds about two collisions; its width is adapted as the pace of collisions changes. The
// table has one slot for every one or two gaps, so that few entries are further ahead than one round.
class TimeSlotsEngine {
 public:
  TimeSlotsEngine(const cradle::Particles<double>& particles, Law law);

  // Makes every collision at times <= until.
  void advance(double until);

  std::uint64_t collisions() const { return collisions_; }

 private:
  static constexpr std::uint32_t nobody = ~std::uint32_t{0};
  static constexpr std::uint64_t nowhere = ~std::uint64_t{0};

  struct Gap {
    double gap, closing, time;  // at `time`
    double due = never;
    std::uint64_t slot = nowhere;  // counted from time 0; the place in the table is this modulo its size
    std::uint32_t next = nobody, previous = nobody;
  };

  std::uint32_t first();
  void kick(std::uint32_t i, double gain, double time);
  void predict(std::uint32_t i);
  void enter(std::uint32_t i);
  void leave(std::uint32_t i);
  void fit(double time);

  Law law_;
  std::vector<Gap> gaps_;
  std::vector<std::uint32_t> slots_;
  double slots_per_time_ = 1;
  std::uint64_t now_ = 0;      // the current slot
  std::uint64_t entered_ = 0;  // gaps in the table
  std::uint64_t collisions_ = 0, fitted_at_ = 0, next_fit_ = 0;
  double fitted_time_ = 0;
};

// ---- particles that merge or pass through each other

// On a line or a ring: absolute positions and velocities, links between the remaining neighbours, an indexed heap of
// the times when gaps close. It holds every particle of the scene from the start.
class MergingEngine {
 public:
  // `loss`: of the wet law; sticky particles if negative.
  MergingEngine(const cradle::Particles<double>& particles, double loss);

  // Makes every collision at times <= until.
  void advance(double until);

  std::uint64_t collisions() const { return collisions_; }

 private:
  struct Particle : Flying {
    double m;
    std::uint32_t left, right;
  };

  double due(std::uint32_t i, double now) const;

  double loss_, circumference_;
  std::vector<Particle> particles_;
  IndexedHeap heap_;
  std::uint64_t collisions_ = 0;
};

}  // namespace twins
