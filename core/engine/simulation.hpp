#pragma once
// The event loop takes the next collision, lets the chain apply the law, updates the queue for the three gaps that
// change, and enters the loss in the ledger. The scalar, the law and the chain are template parameters. All rare work
// is done between collisions, by `review`, off the hot path.
//
// The order of collisions is (exact time, position in the line). Where the queue's keys cannot decide which collision
// is first, the exact times of all collisions that might be first are compared (ties.hpp).
//
// A run makes the same collisions with the same bits, however often `advance` is called and up to whichever times.

#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "cradle/core/base/state.hpp"
#include "cradle/core/chains/chain.hpp"
#include "cradle/core/chains/collision_result.hpp"
#include "cradle/core/chains/configuration.hpp"
#include "cradle/core/engine/collapse.hpp"
#include "cradle/core/engine/pacing.hpp"
#include "cradle/core/engine/standstill.hpp"
#include "cradle/core/engine/status.hpp"
#include "cradle/core/engine/ties.hpp"
#include "cradle/core/laws/law.hpp"
#include "cradle/core/laws/one_of.hpp"
#include "cradle/core/queue/event_queue.hpp"

namespace cradle {

template <Real T, class Law, class Chain>
requires CollidesBy<Chain, Law> && std::same_as<T, typename Chain::Scalar>
class Simulation {
 public:
  using Scalar = T;

  // Throws std::invalid_argument if the chain holds a number that is not finite.
  Simulation(Law law, Chain chain, Policy<T> policy = {}, int least_queue_bits = 3)
      : law_(std::move(law)), chain_(std::move(chain)), policy_(std::move(policy)), least_queue_bits_(least_queue_bits),
        queue_(chain_.slots(), Chain::keys_are_exact, least_queue_bits),
        last_collision_(chain_.local_time(chain_.start())), pacing_(last_collision_, Chain::may_collapse),
        standstill_(last_collision_, has_threshold(law_) || can_rest(), followed()), target_{chain_.start(),
                                                                                             last_collision_,
                                                                                             last_collision_} {
    const T least = smallest_gap(chain_);
    const bool watched = policy_.collapse == CollapsePolicy::stop && chain_.first() <= chain_.last();
    const T floor = watched ? watch_.begin(chain_, least) : T(std::numeric_limits<T>::min());
    chain_.set_floor(watched && floor < policy_.stop_gap ? policy_.stop_gap : floor);
    fill_queue();
    aim();
  }

  // Makes every collision at times <= until. If the status is not `reached`, the run ends at its last collision. Throws
  // std::invalid_argument for a time that is not finite, or before the last collision.
  Status advance(const T& until) {
    head_for(until);
    return make_collisions();
  }
  // Does the same in segments (segments.hpp). The plain loop is used instead if the run may stop at a collision, if the
  // law has memory, or if anything falls or is shaken.
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

  // The same collision by collision, for several simulations side by side in one thread:
  // `run.head_for(until); while (run.step()) ...; run.status()`.
  void head_for(const T& until) {
    require_ahead(until, last_collision_time());
    target_.until = until;
    status_ = Status::reached;
    aim();
  }
  // Makes the next collision; false if there is none, or if it is the last one.
  [[gnu::always_inline]] bool step() {
    const auto next = queue_.next();
    Slot s = queue_.slot(next);
    if (next >= target_.certainly_before) [[unlikely]] {
      if (!first_within_target(s)) return false;
      if (observer_) notify_observer(s);
    } else if (queue_.contested()) [[unlikely]] {
      s = first_of_tied();
    }
    const T time = chain_.due(s);
    const CollisionResult<T> collision = chain_.collide(law_, s, time);
    queue_.replace(collision.left, collision.due_left, s, collision.due, collision.right, collision.due_right);
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
  const Chain& chain() const { return chain_; }
  const Account<T>& account() const { return chain_.account(); }

  // The state at a time between the last collision and the time advanced to.
  Configuration<T> configuration(const T& time) const {
    Configuration<T> now = chain_.configuration(local(time));
    now.time = time;  // the clock, which counts from its origin, rounds it
    return now;
  }
  // The state right after the last collision. At the rounded time of the scene, gaps that close within the rounding
  // would be negative.
  Configuration<T> configuration_at_last_collision() const { return chain_.configuration(last_collision_); }
  bool on_ring() const { return chain_.on_ring(); }
  ParticleIndex collided_particles() const { return chain_.collided_particles(); }
  T front_left(const T& time) const { return chain_.front_left(local(time)); }
  T front_right(const T& time) const { return chain_.front_right(local(time)); }
  // The gap between a wall and the particle beside it, at such a time; nothing if there is no wall.
  std::optional<T> gap_to_wall(End end, const T& time) const {
    if constexpr (requires { chain_.walls(); }) {
      const Slot s = end == End::left ? chain_.first() : chain_.last();
      const ParticleIndex gap = chain_.particle(s);
      const auto& walls = chain_.walls();
      if (end == End::left ? walls.left_of(gap) : walls.right_of(gap)) return chain_.gap_at(s, local(time));
    }
    return {};
  }
  const Counts& counts() const { return counts_; }
  T energy_lost() const { return chain_.energy_lost(); }
  // At a time between the last collision and the time advanced to, which matters if a wall carries a particle.
  T energy_lost(const T& time) const {
    if constexpr (requires { wall_tallies(time); })
      if (falls()) return chain_.energy_lost() - (given_by(wall_tallies(time)) - given_by(chain_.walls().tallies()));
    return chain_.energy_lost();
  }
  WallTallies<T> wall_tallies(const T& time) const requires requires(const Chain& c) { c.walls(); }
  {
    if constexpr (requires { chain_.walls_at(time); })
      return chain_.walls_at(local(time)).tallies();
    else
      return chain_.walls().tallies();
  }
  // After the last collision; at a time between it and the time advanced to, which matters if particles fall.
  T kinetic_energy() const { return chain_.kinetic_energy(last_collision_); }
  T kinetic_energy(const T& time) const { return chain_.kinetic_energy(local(time)); }
  bool falls() const { return cradle::falls(chain_); }
  // The start if there has been no collision.
  T last_collision_time() const { return chain_.stamp(last_collision_).value(); }
  const CollapseReport<T>& collapse() const { return watch_.report; }

  // Checkpoint state (state.hpp), between calls of `advance`: everything that later collisions depend on, except law,
  // particles and policy.
  static auto state(auto& self) {
    return std::tie(self.chain_, self.last_collision_, self.counts_, self.pacing_, self.standstill_, self.watch_);
  }
  void loaded() {
    const T since = last_collision_time() - chain_.start();
    require_state(pacing_.follows(counts_.collisions, last_collision_, since, chain_.count()), "pacing"),
        release_queue();
  }

 private:
  // An advance that is observed.
  struct Observed {
    template <class Observer> Observed(Simulation& of, const T& until, Observer& observer) : run(of) {
      run.head_for(until);
      run.observer_ = std::ref(observer);
      run.aim();
    }
    ~Observed() { run.observer_ = nullptr; }
    Observed(const Observed&) = delete;
    Observed& operator=(const Observed&) = delete;
    Simulation& run;
  };

  // The local time of a reading. Where particles fall, the rounded time of the last collision stands for the state
  // which that collision has left: at any other time a particle that has come to rest on a floor would have fallen for
  // a rounding.
  T local(const T& time) const {
    if (falls() && time == last_collision_time()) return last_collision_;
    return chain_.local_time(time);
  }
  // Whether particles slower than a given speed come to rest on a wall.
  bool can_rest() const {
    if constexpr (requires { chain_.particles(); })
      return falls() && chain_.particles().holding() != nullptr;
    else
      return false;
  }
  // By what factor gaps shrink until the run stops at a given size.
  T followed() const {
    if (!policy_.follows_a_gap() || chain_.last() < chain_.first()) return T(1);
    const T factor = smallest_gap(chain_) / policy_.stop_gap;
    return T(1) < factor ? factor : T(1);
  }
  bool plain_only() const { return policy_.collapse == CollapsePolicy::stop || has_memory<T>(law_) || falls(); }

  void fill_queue() {
    queue_ = EventQueue(chain_.slots(), Chain::keys_are_exact, least_queue_bits_);
    queue_holds_ = true;
    refill_queue();
  }
  void refill_queue() {
    if (!queue_holds_) return;
    for (Slot s = chain_.first(); s <= chain_.last(); ++s) queue_.set(s, chain_.queue_due(s));
    queue_.rebuild(chain_.first(), chain_.last());
    ties_.forget();
  }
  // The plain loop needs a queue of all gaps (and fills one if there is none), time slabs do not.
  void release_queue() {
    if (std::exchange(queue_holds_, false)) queue_ = EventQueue(8, Chain::keys_are_exact);
  }
  [[gnu::noinline]] Status make_collisions() {
    while (step()) continue;
    return status_;
  }
  // Makes so many collisions; false if the run has come to its target before, or ends.
  [[gnu::noinline]] bool make(std::uint64_t collisions) {
    for (; collisions > 0; --collisions)
      if (!step()) return false;
    return true;
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
      release_queue();
      const auto slab = segments.make(chain_, law_, end, pacing_.left(counts_.collisions), observer);
      if (!slab) continue;
      counts_ += slab->counts;
      if (slab->counts.collisions > 0) last_collision_ = slab->last_collision;
      if (!(end < target_.horizon)) return status_;
      from = end == target_.stop ? end_epoch() : end;
      pacing_.passed(counts_.collisions, active());
      status_ = policy_.poll(last_collision_time(), counts_);
      if (status_ != Status::reached) return status_;
    }
  }

  // The target time as a local time and as keys. Observed collisions all take the slow branch of `step`; without an
  // observer there is no cost.
  void aim() {
    target_.horizon = chain_.local_time(target_.until);
    target_.stop = pacing_.in_epochs && pacing_.epoch_end < target_.horizon ? pacing_.epoch_end : target_.horizon;
    target_.certainly_before = observer_ ? 0 : queue_.certainly_before(chain_.queue_time(target_.stop));
  }

  // The next collision if keys do not decide whether it comes before the target; false if it does not.
  bool first_within_target(Slot& first) {
    if (!queue_holds_) {
      fill_queue();
      aim();
      first = queue_.slot(queue_.next());
    }
    while (!first_by(target_.stop, first)) {
      if (!(target_.stop < target_.horizon)) return false;
      end_epoch();
      first = queue_.slot(queue_.next());
    }
    return true;
  }
  bool first_by(const T& time, Slot& first) {
    if (queue_.next() > queue_.possibly_before(chain_.queue_time(time))) return false;
    const bool contested = queue_.contested();
    if (contested) first = ties_.first(queue_, chain_, counts_.collisions);
    if (!(chain_.due(first) <= time)) return false;
    if (contested) count_close_call();
    return true;
  }
  Slot first_of_tied() {
    count_close_call();
    return ties_.first(queue_, chain_, counts_.collisions);
  }
  void notify_observer(Slot s) {
    const T time = chain_.due(s);
    const auto notify = [&](const T& speed) {
      observer_(
          {chain_.particle(s), chain_.particle(chain_.right(s)), chain_.stamp(time), time - last_collision_, speed});
    };
    if constexpr (requires { chain_.closing_when_due(s); })
      notify(chain_.closing_when_due(s));
    else
      notify(chain_.closing(s));
  }
  // The same for all collisions of a time slab, before the chain takes them over. If the observer throws, the plain
  // loop makes those before.
  template <class Part> void notify_observer(const std::vector<typename Part::Observed>& collisions) {
    const Counts counts = counts_;
    const T last = last_collision_;
    const auto undo = [&] { counts_ = counts, last_collision_ = last; };
    std::uint64_t reported = 0;
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
  // Counts every collision once, even if it is the next one several times before it is made.
  void count_close_call() {
    if (counts_.collisions < close_calls_until_) return;
    ++counts_.close_calls;
    close_calls_until_ = counts_.collisions + 1;
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
        fill_queue();
      }
    const bool move = pacing_.origin_moves(notice, counts_.collisions, last_collision_, active());
    const bool stands_still = (move || !pacing_.in_epochs) &&
                              standstill_.at(last_collision_, elapsed(last_collision_), counts_.collisions, active(),
                                             policy_.follows_a_gap() && rebound(chain_, s).has_value());
    const bool moves = move && !stands_still, poll = moves || counts_.collisions >= pacing_.next_review;
    const T before = last_collision_;
    if (moves) move_origin(before);
    if (moves || !pacing_.in_epochs) standstill_.time = last_collision_;
    pacing_.reviewed(counts_.collisions, before, last_collision_, active(), moves);
    aim();
    if (stands_still) return Status::exhausted;
    return judged == Status::reached && poll ? policy_.poll(last_collision_time(), counts_) : judged;
  }
  T elapsed(const T& local) const { return difference(chain_.stamp(local), Pair<T>{chain_.start(), T(0)}); }
  std::uint64_t active() const { return static_cast<std::uint64_t>(chain_.collided_particles()); }

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
    refill_queue();
    return called;
  }

  // Whether the gap left beside the last collision, at slot s, ends the run.
  Status judge(Slot s) {
    const bool watched = policy_.collapse == CollapsePolicy::stop;
    const bool followed = watched && watch_.settled(law_, chain_, s, last_collision_, counts_.collisions);
    const T gap = chain_.nearest_gap(s);
    if (watched && !policy_.follows_a_gap() && watch_.ends_unproved(chain_, s, gap)) return Status::collapsed;
    return policy_.after(gap, rebound(chain_, s), watched && watch_.report.settled, followed);
  }

  struct Target {
    T until, horizon;                      // the time to advance to, in the scene and in the chain
    T stop;                                // the end of the epoch if that is earlier, else the horizon
    EventQueue::Key certainly_before = 0;  // collisions with smaller keys come before it and are not observed
  };

  Law law_;
  Chain chain_;
  Policy<T> policy_;
  int least_queue_bits_;
  EventQueue queue_;
  bool queue_holds_ = true;
  T last_collision_;  // local time; the start if there was none
  Counts counts_;
  std::uint64_t close_calls_until_ = 0;  // collisions up to this number have been checked for close calls
  Pacing<T> pacing_;
  Standstill<T> standstill_;
  CollapseWatch<T> watch_;
  Ties<Chain> ties_;
  Target target_;
  std::function<void(const Collision<T>&)> observer_;  // of this advance only
  Status status_ = Status::reached;
};

template <class L, class C> Simulation(L, C) -> Simulation<typename C::Scalar, L, C>;
template <class L, class C, Real T> Simulation(L, C, Policy<T>) -> Simulation<T, L, C>;

}  // namespace cradle
