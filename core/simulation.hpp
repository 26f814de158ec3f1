#pragma once
// The event loop: take the next contact, let the chain apply the law, tell the queue about the three gaps concerned,
// enter the loss in the ledger. Scalar, law and chain are types; everything else happens in `review`, off the hot path.
//
// The order of contacts is (exact time, position in the line), whatever the queue's keys can tell: where they cannot,
// exact times are compared among all contacts that might be first (ties.hpp).
//
// Nothing depends on how often or until when `advance` is called: same initial state, same contacts, same bits.

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "cradle/core/account.hpp"
#include "cradle/core/chain.hpp"
#include "cradle/core/collapse.hpp"
#include "cradle/core/collision.hpp"
#include "cradle/core/configuration.hpp"
#include "cradle/core/event_queue.hpp"
#include "cradle/core/law.hpp"
#include "cradle/core/ledger.hpp"
#include "cradle/core/pacing.hpp"
#include "cradle/core/standstill.hpp"
#include "cradle/core/ties.hpp"

namespace cradle {

enum class Status {
  reached,     // all contacts up to the time asked for are made
  collapsed,   // policy stop: inelastic collapse, see collapse()
  exhausted,   // a gap is about to underflow, or time stands still: the scalar type resolves no more
  interrupted  // the caller's `interrupt` said so
};

struct Counts {
  std::uint64_t contacts = 0;  // all of them: those below the cut-off and merges included
  std::uint64_t below_cutoff = 0;
  std::uint64_t merges = 0;
  std::uint64_t close_calls = 0;  // contacts that the queue's keys could not tell from another one
  std::uint64_t origin_moves = 0;
};

// A contact as an observer sees it, before the law acts.
template <Real T> struct Contact {
  BodyIndex left, right;  // by their numbers at the start
  Pair<T> time;
  T interval;  // since the contact before it, or the start: resolves what differences of times cannot
  T closing_speed;
};

template <Real T> struct Policy {
  CollapsePolicy collapse = CollapsePolicy::cutoff;
  T stop_gap{0};  // policy stop: go on until a gap is below this; 0: until the collapse time is settled
  // Called after a contact now and then. What they throw leaves `advance`; the run is as it would be without, and can
  // go on.
  std::function<bool()> interrupt = {};  // true ends the run there
  std::function<void(const T& time, const Counts&)> progress = {};
};

template <Real T, class Law, class Chain>
requires CollidesBy<Chain, Law> && std::same_as<T, typename Chain::Scalar>
class Simulation {
 public:
  using Scalar = T;

  // Throws std::invalid_argument where the chain holds a number that is not finite.
  Simulation(Law law, Chain chain, Policy<T> policy = {}, int least_queue_bits = 3)
      : law_(std::move(law)), chain_(std::move(chain)), policy_(std::move(policy)), least_queue_bits_(least_queue_bits),
        queue_(chain_.slots(), Chain::keys_are_exact, least_queue_bits),
        last_contact_(chain_.local_time(chain_.start())), pacing_(last_contact_),
        standstill_(last_contact_), target_{chain_.start(), last_contact_} {
    const T least = smallest_gap();
    watch_below_ = underflow_;
    if (policy_.collapse == CollapsePolicy::stop && chain_.first() <= chain_.last()) watch_below_ = least / T(64);
    if (watch_below_ < policy_.stop_gap) watch_below_ = policy_.stop_gap;
    chain_.set_floor(watch_below_);
    fill_queue();
    aim();
  }

  // Makes every contact at times <= until. Except for `reached`, the run ends with the contact that was made last.
  // Throws std::invalid_argument for a time that is not finite, or before the last contact made.
  Status advance(const T& until) {
    head_for(until);
    return make_contacts();
  }
  // The same, observer(const Contact<T>&) being told of every contact. It may throw: the contact is then still to be
  // made.
  template <class Observer> Status advance(const T& until, Observer&& observer) {
    head_for(until);
    const struct Forget {
      Simulation& run;
      ~Forget() { run.observer_ = nullptr; }
    } forget{*this};
    observer_ = std::ref(observer);
    aim();
    return make_contacts();
  }

  // The same contact by contact, for several simulations side by side in one thread:
  // `run.head_for(until); while (run.step()) ...; run.status()`.
  void head_for(const T& until) {
    if (!is_finite(until))
      throw std::invalid_argument("the time to advance to is not finite (found " + std::to_string(to_double(until)) +
                                  "): give a number");
    if (until < last_contact_time())
      throw std::invalid_argument("the time to advance to is in the past (found " + std::to_string(to_double(until)) +
                                  ", the last contact was at " + std::to_string(to_double(last_contact_time())) +
                                  "): a run goes forward only");
    target_.until = until;
    status_ = Status::reached;
    aim();
  }
  // Makes the next contact; false where there is none to make, or it is the last one.
  [[gnu::always_inline]] bool step() {
    const auto next = queue_.next();
    Slot s = queue_.slot(next);
    if (next >= target_.certainly_before) [[unlikely]] {
      if (!first_within_target(s)) return false;
      if (observer_) tell_observer(s);
    } else if (queue_.contested()) [[unlikely]] {
      s = first_of_tied();
    }
    const T time = chain_.due(s);
    const Collision<T> collision = chain_.collide(law_, s, time);
    queue_.replace(collision.left, collision.due_left, s, collision.due, collision.right, collision.due_right);
    last_contact_ = time;
    lost_.add(collision.outcome.energy_lost);
    counts_.below_cutoff += collision.outcome.below_cutoff;
    counts_.merges += collision.outcome.event == Event::merge;
    if (++counts_.contacts >= pacing_.next_review || collision.notice != Notice::none) [[unlikely]] {
      status_ = review(s, collision.notice);
      return status_ == Status::reached;
    }
    return true;
  }
  Status status() const { return status_; }

  const Law& law() const { return law_; }
  const Chain& chain() const { return chain_; }
  const Account<T>& account() const { return chain_.account(); }

  // The state at a time not before the last contact made nor after the time advanced to.
  Configuration<T> configuration(const T& time) const { return chain_.configuration(chain_.local_time(time)); }
  bool on_ring() const { return chain_.on_ring(); }
  BodyIndex collided_bodies() const { return chain_.collided_bodies(); }
  T front_left(const T& time) const { return chain_.front_left(chain_.local_time(time)); }
  T front_right(const T& time) const { return chain_.front_right(chain_.local_time(time)); }

  const Counts& counts() const { return counts_; }
  T energy_lost() const { return lost_.value(); }
  // The start if there was no contact yet.
  T last_contact_time() const { return chain_.stamp(last_contact_).value(); }
  const CollapseReport<T>& collapse() const { return watch_.report; }

 private:
  // Of those held; throws where one is not a number.
  T smallest_gap() const {
    const T start = chain_.local_time(chain_.start());
    T least = far_away<T>();
    for (Slot s = chain_.first(); s <= chain_.last(); ++s) {
      const T gap = chain_.gap_at(s, start);
      if (!is_finite(gap) || !is_finite(T(chain_.closing(s))))
        throw std::invalid_argument("the distance or closing speed of bodies " + std::to_string(chain_.body(s)) +
                                    " and the next is not finite: check their positions and velocities");
      if (gap < least) least = gap;
    }
    return least;
  }

  void fill_queue() {
    queue_ = EventQueue(chain_.slots(), Chain::keys_are_exact, least_queue_bits_);
    refill_queue();
  }
  void refill_queue() {
    for (Slot s = chain_.first(); s <= chain_.last(); ++s) queue_.set(s, chain_.queue_due(s));
    queue_.rebuild(chain_.first(), chain_.last());
    ties_.forget();
  }

  [[gnu::noinline]] Status make_contacts() {
    while (step()) {
    }
    return status_;
  }

  // Where to go, in the terms of the chain and the queue as they are now. Of an observed run every contact is one to
  // look at more closely, so that the others have nothing to pay.
  void aim() {
    target_.horizon = chain_.local_time(target_.until);
    target_.certainly_before = observer_ ? 0 : queue_.certainly_before(chain_.queue_time(target_.horizon));
  }

  // The next contact where keys do not tell whether it comes in time; false if it does not.
  bool first_within_target(Slot& first) {
    if (queue_.next() > queue_.possibly_before(chain_.queue_time(target_.horizon))) return false;
    const bool contested = queue_.contested();
    if (contested) first = ties_.first(queue_, chain_, counts_.contacts);
    if (!(chain_.due(first) <= target_.horizon)) return false;
    if (contested) count_close_call();
    return true;
  }
  void tell_observer(Slot s) {
    const T time = chain_.due(s);
    observer_(Contact<T>{chain_.body(s), chain_.body(chain_.right(s)), chain_.stamp(time), time - last_contact_,
                         chain_.closing(s)});
  }
  Slot first_of_tied() {
    count_close_call();
    return ties_.first(queue_, chain_, counts_.contacts);
  }
  // Once for every contact, however often it is asked for before it is made.
  void count_close_call() {
    if (counts_.contacts < close_calls_until_) return;
    ++counts_.close_calls;
    close_calls_until_ = counts_.contacts + 1;
  }

  // Looks after everything that is not a contact, after the contact at slot s. What it does depends on the history of
  // contacts only. What the caller has asked to be called comes last, since it may throw.
  Status review(Slot s, Notice notice) {
    const Status judged = asks(notice, Notice::gap_below_floor) ? judge(s) : Status::reached;
    if constexpr (StreamingChain<Chain>)
      if (asks(notice, Notice::needs_slots)) {
        chain_.make_room();
        fill_queue();
      }
    const auto active = static_cast<std::uint64_t>(chain_.collided_bodies());
    const bool stands_still = standstill_.at(last_contact_, counts_.contacts, active);
    const bool moves =
        !stands_still && pacing_.origin_moves(notice, counts_.contacts, last_contact_, active, Chain::may_collapse);
    if (moves) move_origin();
    standstill_.time = last_contact_;
    pacing_.reviewed(counts_.contacts, last_contact_, active, moves);
    aim();
    if (stands_still) return Status::exhausted;
    if (judged != Status::reached || !moves) return judged;
    if (policy_.progress) policy_.progress(last_contact_time(), counts_);
    return policy_.interrupt && policy_.interrupt() ? Status::interrupted : Status::reached;
  }

  // To the last contact.
  void move_origin() {
    const T before = last_contact_;
    last_contact_ = chain_.move_origin(before);
    watch_.origin_moved(T(before - last_contact_));
    ++counts_.origin_moves;
    refill_queue();
  }

  // Whether the gap that the last contact, at slot s, has left beside it ends the run.
  Status judge(Slot s) {
    const T gap = chain_.nearest_gap(s);
    if (policy_.collapse == CollapsePolicy::stop) {
      const bool settled = watch_.settled(chain_.body(s), chain_.stamp(last_contact_), last_contact_, gap,
                                          chain_.time_resolution(s, last_contact_));
      // Without a time that settles (irregular collapse of many bodies) the end of the type's range is the end too.
      const T stop_gap = policy_.stop_gap > T(0) ? policy_.stop_gap : underflow_;
      if ((settled && !(policy_.stop_gap > T(0))) || (is_positive(gap) && gap < stop_gap)) return Status::collapsed;
    }
    return gap > T(0) && gap < underflow_ ? Status::exhausted : Status::reached;
  }

  struct Target {
    T until, horizon;                      // the time to go to, of the scene and as the chain calls it
    EventQueue::Key certainly_before = 0;  // contacts with lesser keys come before it, and nobody observes them
  };

  Law law_;
  Chain chain_;
  Policy<T> policy_;
  int least_queue_bits_;
  EventQueue queue_;
  T last_contact_;  // local time; the start if there was none
  Ledger<T> lost_;
  Counts counts_;
  std::uint64_t close_calls_until_ = 0;  // contacts up to this number have been looked at for close calls
  Pacing<T> pacing_;
  Standstill<T> standstill_;
  CollapseWatch<T> watch_;
  Ties<Chain> ties_;
  Target target_;
  std::function<void(const Contact<T>&)> observer_;  // of this advance only
  Status status_ = Status::reached;
  T underflow_{std::numeric_limits<T>::min()};  // 0 in exact arithmetic, which knows no underflow
  T watch_below_{0};
};

template <class Law, class Chain> Simulation(Law, Chain) -> Simulation<typename Chain::Scalar, Law, Chain>;
template <class Law, class Chain, Real T> Simulation(Law, Chain, Policy<T>) -> Simulation<T, Law, Chain>;

}  // namespace cradle
