#pragma once
// The event loop takes the next collision, lets the chain apply the law, updates the queue for the three gaps that
// change, and enters the loss in the ledger. The scalar, the law and the chain are template parameters. All rare work
// is done between collisions, by `review`, off the hot path.
//
// A run makes the same collisions with the same bits, however often `advance` is called and up to whichever times.

#include <concepts>
#include <functional>
#include <limits>

#include "cradle/core/base/state.hpp"
#include "cradle/core/engine/collapse.hpp"
#include "cradle/core/engine/next_collision.hpp"
#include "cradle/core/engine/pacing.hpp"
#include "cradle/core/engine/readings.hpp"
#include "cradle/core/laws/one_of.hpp"

namespace cradle {

template <Real T, class Law, class Chain>
requires CollidesBy<Chain, Law> && std::same_as<T, typename Chain::Scalar>
class Simulation : public Readings<Chain> {
  using Read = Readings<Chain>;

 public:
  using Read::last_collision_time;

  // Throws std::invalid_argument if the chain holds a number that is not finite.
  Simulation(Law law, Chain chain, Policy<T> policy = {}, int least_queue_bits = 3)
      : Read(std::move(chain)), law_(std::move(law)), policy_(std::move(policy)), next_(chain_, least_queue_bits),
        pacing_(last_collision_, Chain::may_collapse),
        standstill_(last_collision_), target_{chain_.start(), last_collision_, last_collision_} {
    begin();
  }
  // The run from the same start with other particles, in the memory of this one.
  void begin_again(std::shared_ptr<const Particles<T>> particles) {
    Read::begin_again(std::move(particles));
    if (policy_.collapse == CollapsePolicy::stop) watch_ = {};
    begin();
  }

  // Makes every collision at times <= until. If the status is not `reached`, the run ends at its last collision. Throws
  // std::invalid_argument for a time that is not finite, or before the last collision.
  Status advance(const T& until) {
    head_for(until);
    return make_collisions();
  }
  // Does the same in segments (segments.hpp). The plain loop is used instead if the run may stop at a collision, if the
  // law has memory, or if particles can rest on a wall.
  template <class Segments>
  requires requires { typename Segments::TimeSlab; }
  Status advance(const T& until, Segments& segments) {
    head_for(until);
    return plain_only() ? make_collisions() : make_slabs(segments);
  }
  // The same, with observer(const Collision<T>&) called before every collision, in their order. If it throws, the
  // collision has not been made.
  template <class Observer> Status advance(const T& until, Observer&& observer) {
    const Observed observed(*this, until, observer);
    return make_collisions();
  }
  // The same in segments. The observer may read the counts, but not the particles: they are as they were before the
  // time slab.
  template <class Segments, class Observer>
  requires requires { typename Segments::TimeSlab; }
  Status advance(const T& until, Segments& segments, Observer&& observer) {
    const Observed observed(*this, until, observer);
    return plain_only() ? make_collisions() : make_slabs(segments);
  }

  // The same, one by one: `run.head_for(until); while (run.step()) ...; run.status()`.
  void head_for(const T& until) {
    require_ahead(until, last_collision_time());
    target_.until = until;
    status_ = Status::reached;
    aim();
  }
  // Makes the next collision; false if there is none, or if it is the last one.
  [[gnu::always_inline]] bool step() {
    const auto next = next_.queue.next();
    Slot s = next_.queue.slot(next);
    if (next >= target_.certainly_before) [[unlikely]] {
      if (!first_within_target(s)) return false;
      if (observer_) notify_observer(s);
    } else if (next_.queue.contested()) [[unlikely]] {
      s = next_.first_of_tied(chain_, counts_);
    }
    const T time = chain_.due(s);
    const CollisionResult<T> collision = chain_.collide(law_, s, time);
    next_.queue.replace(collision.left, collision.due_left, s, collision.due, collision.right, collision.due_right);
    last_collision_ = time;
    chain_.lose(s, collision.outcome.energy_lost);
    counts_.below_cutoff += collision.outcome.below_cutoff;
    counts_.merges += collision.outcome.event == Event::merge;
    if (++counts_.collisions >= pacing_.next_review || collision.notice != Notice::none) [[unlikely]] {
      status_ = review(s, collision.notice);
      return status_ == Status::reached;
    }
    return true;
  }
  Status status() const { return status_; }
  const CollapseReport<T>& collapse() const { return watch_.report; }

  // Checkpoint state (state.hpp), between calls of `advance`: everything that later collisions depend on, except law,
  // particles and policy.
  static auto state(auto& self) {
    return fields(self.chain_, self.last_collision_, self.counts_, self.pacing_, self.standstill_, self.watch_);
  }
  void loaded() {
    const T since = last_collision_time() - chain_.start();
    require_state(pacing_.follows(counts_.collisions, last_collision_, since, chain_.count()), "pacing");
    next_.release();
  }

 private:
  using Read::active, Read::can_rest, Read::chain_, Read::counts_, Read::elapsed, Read::last_collision_;

  // An advance that is observed.
  struct Observed {
    template <class Observer> Observed(Simulation& of, const T& until, Observer& observer) : run(of) {
      run.head_for(until);
      run.observer_ = std::ref(observer);
      run.aim();
    }
    ~Observed() { run.observer_ = nullptr; }
    Observed(const Observed&) = delete;
    Simulation& run;
  };
  void begin() {
    const bool watched = policy_.collapse == CollapsePolicy::stop && chain_.first() <= chain_.last();
    const T floor = watched ? watch_.begin(chain_, smallest_gap(chain_)) : T(std::numeric_limits<T>::min());
    chain_.set_floor(watched && floor < policy_.stop_gap ? policy_.stop_gap : floor);
    pacing_ = Pacing<T>(last_collision_, Chain::may_collapse);
    standstill_ = Standstill<T>(last_collision_, has_threshold(law_) || can_rest(), policy_.followed(chain_));
    target_.until = chain_.start();
    next_.begin_again(chain_);
    aim();
  }
  bool plain_only() const { return policy_.collapse == CollapsePolicy::stop || has_memory<T>(law_) || can_rest(); }

  [[gnu::noinline]] Status make_collisions() {
    while (step()) continue;
    return status_;
  }
  // Makes so many collisions; false if the run has come to its target before, or ends.
  [[gnu::noinline]] bool make(std::uint64_t collisions) {
    while (collisions > 0 && step()) --collisions;
    return collisions == 0;
  }

  // The slab loop: time slabs in segments; where these cannot be used, collisions in the plain loop.
  template <class Segments> Status make_slabs(Segments& segments) {
    typename Segments::Observer observer;
    if (observer_) observer = [this](const auto& collisions) { notify_observer<typename Segments::Part>(collisions); };
    for (T from = last_collision_;;) {
      const double ahead = pacing_.ahead(counts_.collisions, from, target_.stop);
      if (auto plain = segments.plain_collisions(chain_, ahead)) {
        if (!make(plain)) return status_;
        from = last_collision_;
        continue;
      }
      const T end = segments.end(chain_, from, target_.stop, ahead, static_cast<bool>(observer));
      next_.release();
      const auto slab = segments.make(chain_, law_, end, pacing_.left(counts_.collisions), observer);
      if (!slab) continue;
      counts_ += slab->counts;
      if (slab->counts.collisions > 0) last_collision_ = slab->last_collision;
      if (!(end < target_.horizon)) return status_;
      from = end == target_.stop ? end_epoch() : end;
      pacing_.set_next_review(counts_.collisions, active());
      status_ = policy_.poll(last_collision_time(), counts_);
      if (status_ != Status::reached) return status_;
    }
  }

  // Observed collisions all take the slow branch of `step`; without an observer there is no cost.
  void aim() { target_.aim(chain_, pacing_, next_.queue, static_cast<bool>(observer_)); }

  // The next collision if keys do not decide whether it comes before the target; false if it does not.
  bool first_within_target(Slot& first) {
    if (!next_.has_queue()) {
      next_.fill(chain_);
      aim();
      first = next_.queue.slot(next_.queue.next());
    }
    while (!next_.is_by(target_.stop, chain_, counts_, first)) {
      if (!(target_.stop < target_.horizon)) return false;
      end_epoch();
      first = next_.queue.slot(next_.queue.next());
    }
    return true;
  }
  void notify_observer(Slot s) {
    const T time = chain_.due(s);
    T speed = chain_.closing(s);
    if constexpr (requires { chain_.closing_when_due(s); }) speed = chain_.closing_when_due(s);
    observer_(
        {chain_.particle(s), chain_.particle(chain_.right(s)), chain_.stamp(time), time - last_collision_, speed});
  }
  // The same for all collisions of a time slab, before the chain takes them over. If the observer throws, the plain
  // loop makes those before.
  template <class Part> void notify_observer(const std::vector<typename Part::Observed>& collisions) {
    std::uint64_t reported = 0;
    const auto undo = [&, counts = counts_, last = last_collision_] { counts_ = counts, last_collision_ = last; };
    try {
      for (const auto& c : collisions) {
        const auto [left, right] = Part::particles(chain_, c);
        observer_({left, right, chain_.stamp(c.time), c.time - last_collision_, c.closing_speed});
        last_collision_ = c.time;
        counts_.below_cutoff += c.below_cutoff, counts_.merges += c.merges, ++counts_.collisions, ++reported;
      }
    } catch (...) {
      undo();
      observer_ = nullptr;
      aim();
      make(reported);
      throw;
    }
    undo();
  }
  // All work besides collisions, after the one at slot s. It depends on the history of collisions only. The caller's
  // functions come last, since they may throw.
  Status review(Slot s, Notice notice) {
    if (notice == Notice::origin_should_move && pacing_.in_epochs && counts_.collisions < pacing_.next_review)
      return Status::reached;  // within an epoch the origin does not move
    const Status judged = includes(notice, Notice::gap_below_floor) ? judge(s) : Status::reached;
    if constexpr (StreamingChain<Chain>)
      if (includes(notice, Notice::needs_slots)) {
        chain_.make_room();
        next_.fill(chain_);
      }
    const bool move = pacing_.origin_moves(notice, counts_.collisions, last_collision_, active());
    const bool stands_still = (move || !pacing_.in_epochs) &&
                              standstill_.at(last_collision_, elapsed(last_collision_), counts_.collisions, active(),
                                             policy_.follows_a_gap() && chain_.rebound(s).has_value());
    const bool moves = move && !stands_still, poll = moves || counts_.collisions >= pacing_.next_review;
    const T before = last_collision_;
    if (moves) move_origin(before);
    if (moves || !pacing_.in_epochs) standstill_.time = last_collision_;
    pacing_.reviewed(counts_.collisions, before, last_collision_, active(), moves);
    aim();
    if (stands_still) return Status::exhausted;
    return judged == Status::reached && poll ? policy_.poll(last_collision_time(), counts_) : judged;
  }
  // No collision is left in this epoch. Returns the new local time of its end.
  T end_epoch() {
    const T now = move_origin(pacing_.epoch_end);
    pacing_.epoch_ended(counts_.collisions, now, active());
    standstill_.epoch_ended(now, elapsed(now), counts_.collisions);
    aim();
    return now;
  }
  // Returns the new local time of the new origin.
  T move_origin(const T& to) {
    const T called = chain_.move_origin(to);
    const T by = to - called;
    last_collision_ -= by;
    watch_.origin_moved(by);
    ++counts_.origin_moves;
    next_.refill(chain_);
    return called;
  }

  // Whether the gap left beside the last collision, at slot s, ends the run.
  Status judge(Slot s) {
    const bool watched = policy_.collapse == CollapsePolicy::stop;
    const bool followed = watched && watch_.record(law_, chain_, s, last_collision_, counts_.collisions);
    const T gap = chain_.nearest_gap(s);
    if (watched && !policy_.follows_a_gap() && watch_.ends_unproved(chain_, s, gap)) return Status::collapsed;
    return policy_.after(gap, chain_.rebound(s), watched && watch_.report.settled, followed);
  }

  Law law_;
  Policy<T> policy_;
  NextCollision<Chain> next_;
  Pacing<T> pacing_;
  Standstill<T> standstill_;
  CollapseWatch<T> watch_;
  Target<T> target_;
  std::function<void(const Collision<T>&)> observer_;  // of this advance only
  Status status_ = Status::reached;
};

template <class L, class C> Simulation(L, C) -> Simulation<typename C::Scalar, L, C>;
template <class L, class C, Real T> Simulation(L, C, Policy<T>) -> Simulation<T, L, C>;

}  // namespace cradle
