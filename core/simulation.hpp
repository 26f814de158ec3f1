#pragma once
// The event loop: take the next contact, let the chain apply the law, tell the queue about the three gaps concerned,
// enter the loss in the ledger. Scalar, law and chain are types; everything else happens in `review`, off the hot path.
//
// The order of contacts is (exact time, position in the line). Contacts at gaps that are neither the same nor
// neighbours nor share a gap between them commute exactly, so only those up to two gaps away are compared beyond what
// the queue's keys tell.
//
// Nothing depends on how often or until when `advance` is called: same initial state, same contacts, same bits.

#include <concepts>
#include <cstddef>
#include <functional>
#include <type_traits>
#include <utility>

#include "cradle/core/account.hpp"
#include "cradle/core/chain.hpp"
#include "cradle/core/collapse.hpp"
#include "cradle/core/collision.hpp"
#include "cradle/core/configuration.hpp"
#include "cradle/core/event_queue.hpp"
#include "cradle/core/law.hpp"

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
  std::uint64_t close_calls = 0;  // contacts whose order the queue's keys could not tell from a neighbour's
  std::uint64_t origin_moves = 0;
};

// A contact as an observer sees it, before the law acts.
template <Real T> struct Contact {
  BodyIndex left, right;  // by their numbers at the start
  Pair<T> time;
  T interval;  // since the contact before it, if that was observed: resolves what differences of times cannot
  T closing_speed;
};

template <Real T> struct Policy {
  CollapsePolicy collapse = CollapsePolicy::cutoff;
  T stop_gap{0};  // policy stop: go on until a gap is below this; 0: until the collapse time is settled
  std::function<bool()> interrupt = {};  // asked now and then; true ends the run after the current contact
  std::function<void(const T& time, const Counts&)> progress = {};  // told now and then
};

// Sum of the energies lost: compensated where the type has no digits to spare for 1e12 terms.
template <Real T> class Ledger {
 public:
  void add(const T& loss) {
    if constexpr (compensated)
      sum_.add(loss);
    else
      sum_.sum += loss;
  }
  T value() const { return sum_.value(); }

 private:
  static constexpr bool compensated = std::same_as<T, float> || std::same_as<T, double> || std::same_as<T, long double>;
  CompensatedSum<T> sum_;
};

template <Real T, class Law, class Chain>
requires CollidesBy<Chain, Law> && std::same_as<T, typename Chain::Scalar>
class Simulation {
 public:
  using Scalar = T;

  Simulation(Law law, Chain chain, Policy<T> policy = {}, int least_queue_bits = 3)
      : law_(std::move(law)), chain_(std::move(chain)), policy_(std::move(policy)), least_queue_bits_(least_queue_bits),
        queue_(chain_.slots(), Chain::keys_are_exact, least_queue_bits) {
    fill_queue();
    underflow_ = std::numeric_limits<T>::min();  // 0 in exact arithmetic, which knows no underflow
    watch_below_ = policy_.collapse == CollapsePolicy::stop && chain_.last() >= chain_.first()
                       ? T(smallest_gap() / T(64))
                       : underflow_;
    if (watch_below_ < policy_.stop_gap) watch_below_ = policy_.stop_gap;
    chain_.set_floor(watch_below_);
  }

  // Makes every contact at times <= until. Except for `reached`, the run ends with the contact that was made last.
  // An observer is told of every contact, observer(const Contact<T>&); without one there is nothing to pay.
  template <class Observer = std::nullptr_t> Status advance(const T& until, Observer&& observer = nullptr) {
    Course course = course_to(until);
    while (step(course, observer)) {
    }
    return course.status;
  }

  // The same contact by contact: `while (step(course)) ...`. For several simulations side by side in one thread.
  struct Course {
    T until, horizon;  // the time to go to, and what it is called since the origin moved last
    EventQueue::Key certainly_before;
    Status status = Status::reached;
  };
  Course course_to(const T& until) const {
    const T horizon = chain_.local_time(until);
    return {until, horizon, queue_.certainly_before(chain_.queue_time(horizon))};
  }
  // Makes the next contact; false where there is none to make, or it is the last one: course.status says why.
  template <class Observer = std::nullptr_t>
  [[gnu::always_inline]] bool step(Course& course, Observer&& observer = nullptr) {
    constexpr bool observed = !std::same_as<std::remove_cvref_t<Observer>, std::nullptr_t>;
    const auto next = queue_.next();
    Slot s = queue_.slot(next);
    if (next >= course.certainly_before) [[unlikely]] {
      if (!earliest_until(course.horizon, s)) return false;
    } else if (queue_.contested()) [[unlikely]] {
      s = earliest_near(next);
    }
    const T time = chain_.due(s);
    if constexpr (observed) {
      observer(Contact<T>{chain_.body(s), chain_.body(chain_.right(s)), chain_.stamp(time), time - previous_,
                          chain_.closing(s)});
      previous_ = time;
    }
    const Collision<T> collision = chain_.collide(law_, s, time);
    queue_.replace(collision.left, collision.due_left, s, collision.due, collision.right, collision.due_right);
    lost_.add(collision.outcome.energy_lost);
    counts_.below_cutoff += collision.outcome.below_cutoff;
    counts_.merges += collision.outcome.event == Event::merge;
    if (++counts_.contacts == next_review_ || collision.notice != Notice::none) [[unlikely]] {
      course.status = review(s, time, collision.notice);
      if (course.status != Status::reached) return false;
      course = course_to(course.until);
    }
    return true;
  }

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
  T last_contact_time() const { return chain_.stamp(last_contact_).value(); }
  const CollapseReport<T>& collapse() const { return watch_.report(); }

 private:
  T smallest_gap() const {
    const T start = chain_.local_time(chain_.start());
    T least = chain_.gap_at(chain_.first(), start);
    for (Slot s = chain_.first(); s <= chain_.last(); ++s) {
      const T gap = chain_.gap_at(s, start);
      if (gap < least) least = gap;
    }
    return least;
  }

  void fill_queue() {
    queue_ = EventQueue(chain_.slots(), Chain::keys_are_exact, least_queue_bits_);
    for (Slot s = chain_.first(); s <= chain_.last(); ++s) queue_.set(s, chain_.queue_due(s));
    queue_.rebuild();
  }

  // Of contacts too close for the keys: the first by exact time, then from the left. Where very many are (a lattice),
  // the first among those that do not commute with it.
  Slot earliest_near(EventQueue::Key root) {
    constexpr int many = 64;
    int candidates = 0;
    Slot s = queue_.slot(root), first = s;
    ++counts_.close_calls;
    if (queue_.for_each_before(queue_.no_later_than(root), [&](Slot other) {
          if (other != first && earlier(other, first)) first = other;
          return ++candidates < many;
        }))
      return first;
    for (;;) {
      first = s;
      for (const Slot other :
           {chain_.left(chain_.left(s)), chain_.left(s), chain_.right(s), chain_.right(chain_.right(s))})
        if (other != s && queue_.close(root, other) && earlier(other, first)) first = other;
      if (first == s) return s;
      s = first;
    }
  }
  bool earlier(Slot a, Slot b) const {
    const T time_a = chain_.due(a), time_b = chain_.due(b);
    return time_a < time_b || (time_a == time_b && a < b);
  }

  // The first contact at a time <= horizon, where keys alone cannot tell; false if there is none.
  bool earliest_until(const T& horizon, Slot& first) const {
    bool found = false;
    queue_.for_each_before(queue_.possibly_before(chain_.queue_time(horizon)), [&](Slot s) {
      if (chain_.due(s) <= horizon && (!found || earlier(s, first))) first = s, found = true;
      return true;
    });
    return found;
  }

  // Looks after everything that is not a contact. What it does depends on the history of contacts only.
  Status review(Slot s, const T& time, Notice notice) {
    last_contact_ = time;
    Status status = Status::reached;
    if (asks(notice, Notice::gap_below_floor)) status = judge(s, time);
    if constexpr (StreamingChain<Chain>)
      if (asks(notice, Notice::needs_slots)) {
        chain_.make_room();
        fill_queue();
      }
    if (time > reviewed_) progress_ = counts_.contacts;
    const auto active = static_cast<std::uint64_t>(chain_.collided_bodies());
    // Many bodies may meet at one time, n(n - 1)/2 contacts if elastic; more than that, and time stands still.
    if (counts_.contacts - progress_ > 64 + 4 * active * active) return Status::exhausted;
    const bool moved = time_to_move(time, notice, active);
    if (moved) {
      move_origin(time);
      if (policy_.progress) policy_.progress(chain_.stamp(reviewed_).value(), counts_);
      if (status == Status::reached && policy_.interrupt && policy_.interrupt()) status = Status::interrupted;
    } else {
      reviewed_ = time;
    }
    if (moved || counts_.contacts >= next_review_) {
      paced_ = moved ? reviewed_ : time;
      last_pace_ = counts_.contacts;
      next_review_ = counts_.contacts + std::min(32 * active + 16, active * active / 8 + 1);
    }
    return status;
  }

  // A move of the origin costs as much as a few contacts per gap: rare in a large zone, with every second contact in a
  // few-body collapse. Bodies that merge do not collapse: there the origin moves only where contacts come ever faster.
  // (Looked at when due, never when the chain asks for room: that depends on what is streamed.)
  bool time_to_move(const T& time, Notice notice, std::uint64_t active) const {
    const std::uint64_t since_move = counts_.contacts - last_move_;
    if (asks(notice, Notice::origin_must_move)) return true;
    if (asks(notice, Notice::origin_should_move) && 16 * since_move >= active) return true;
    if (counts_.contacts < next_review_) return false;
    if (Chain::may_collapse || since_move >= 32 * active + 16) return true;
    return T(static_cast<std::int64_t>(2 * since_move)) * (time - paced_) <
           T(static_cast<std::int64_t>(counts_.contacts - last_pace_)) * time;
  }

  void move_origin(const T& time) {
    last_contact_ = previous_ = reviewed_ = chain_.move_origin(time);
    watch_.origin_moved(time - reviewed_);
    last_move_ = counts_.contacts;
    ++counts_.origin_moves;
    for (Slot s = chain_.first(); s <= chain_.last(); ++s) queue_.set(s, chain_.queue_due(s));
    queue_.rebuild();
  }

  Status judge(Slot s, const T& time) {
    const T gap = chain_.nearest_gap(s);
    if (policy_.collapse == CollapsePolicy::stop) {
      const bool settled =
          watch_.settled(chain_.body(s), chain_.stamp(time), time, gap, chain_.time_resolution(s, time));
      // Without a time that settles (irregular collapse of many bodies) the end of the type's range is the end too.
      const T stop_gap = policy_.stop_gap > T(0) ? policy_.stop_gap : underflow_;
      if ((settled && !(policy_.stop_gap > T(0))) || (is_positive(gap) && gap < stop_gap)) return Status::collapsed;
    }
    return gap > T(0) && gap < underflow_ ? Status::exhausted : Status::reached;
  }

  Law law_;
  Chain chain_;
  Policy<T> policy_;
  int least_queue_bits_;
  EventQueue queue_;
  Counts counts_;
  Ledger<T> lost_;
  std::uint64_t next_review_ = 1, last_move_ = 0;
  T paced_{0};  // local time and contacts when it was last looked how fast they come
  std::uint64_t last_pace_ = 0;
  std::uint64_t progress_ = 0;  // contacts made when time was last seen to advance
  T reviewed_{0};               // local time at the last review
  T last_contact_{0};           // local times of the last contact: at the last review, and as observed
  T previous_{0};
  T watch_below_{0}, underflow_{0};
  CollapseWatch<T> watch_;
};

template <class Law, class Chain> Simulation(Law, Chain) -> Simulation<typename Chain::Scalar, Law, Chain>;
template <class Law, class Chain, Real T> Simulation(Law, Chain, Policy<T>) -> Simulation<T, Law, Chain>;

}  // namespace cradle
