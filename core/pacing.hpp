#pragma once
// How often the event loop looks after what is not a contact, and when the origin of time moves. Both follow from the
// history of contacts alone, never from who asks or how often.
//
// A small zone is looked after by numbers of contacts. A move of the origin costs as much as a few contacts per gap: it
// comes with every second contact in a few-body collapse and after some 32 contacts per body otherwise.
//
// A large zone goes through time in epochs: when the origin moves next is a time, known since it moved last, so that
// contacts far apart need no common order for it (segments.hpp). An epoch lasts as long as some 8 contacts per active
// body should take, or 32 where bodies merge, by the rate of the epoch before. It ends early, with the contact after
// which that is asked for: where the flight before it was too short for the time since the origin, or where there are
// four times as many contacts per body as it should have.

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "cradle/core/notice.hpp"
#include "cradle/core/real.hpp"

namespace cradle {

template <Real T> struct Pacing {
  Pacing(const T& start, bool may_collapse)
      : time_before(start), may_collapse_(may_collapse), per_body_(may_collapse ? 8 : 32) {}

  static constexpr std::uint64_t large = 512;  // active bodies from which on there are epochs

  std::uint64_t next_review = 1;       // contacts made when the next regular review is due
  std::uint64_t contacts_at_move = 0;  // contacts made when the origin moved last
  std::uint64_t contacts_before = 0;   // contacts made, and the local time, at the regular review or the move before
  T time_before;

  bool in_epochs = false;
  T epoch{0};                       // how long this one is to last, from time_before
  T epoch_end{0};                   // local
  std::uint64_t expected = 0;       // contacts in it
  std::uint64_t next_poll = 0;      // contacts made when the caller is asked again
  std::uint64_t most_contacts = 0;  // made in all when it ends at the latest

  // After a contact at the given local time, with so many bodies active. The chain may ask for a move; at a regular
  // review there is one if bodies can collapse. If they merge instead, the origin moves only after many contacts, or
  // where these come at more than twice the rate, since the review before, that they have had since the last move.
  bool origin_moves(Notice notice, std::uint64_t contacts, const T& time, std::uint64_t active) const {
    const std::uint64_t since_move = contacts - contacts_at_move;
    if (asks(notice, Notice::origin_must_move)) return true;
    if (in_epochs) return contacts >= most_contacts;
    if (asks(notice, Notice::origin_should_move) && 16 * since_move >= active) return true;
    if (contacts < next_review) return false;
    if (may_collapse_ || active >= large || since_move >= 32 * active + 16) return true;
    return T(static_cast<std::int64_t>(2 * since_move)) * (time - time_before) <
           T(static_cast<std::int64_t>(contacts - contacts_before)) * time;
  }

  // After a review at the local time `then`, which is called `now` since. Reviews that a chain asked for
  // (Notice::needs_slots) change nothing: they depend on what is streamed.
  void reviewed(std::uint64_t contacts, const T& then, const T& now, std::uint64_t active, bool moved) {
    const bool regular = contacts >= next_review;
    if (moved && active >= large && (in_epochs ? contacts >= most_contacts : regular))
      foresee(T(then - time_before), contacts - contacts_before, active);
    if (moved) contacts_at_move = contacts;
    if (in_epochs) {
      if (moved) begin_epoch(contacts, now, active);
      return passed(contacts, active);
    }
    if (!moved && !regular) return;
    begin_reviews(contacts, now, active);
  }
  // Contacts to come up to a time in this epoch: by the rate foreseen, or by that so far. 0: no epochs.
  double ahead(std::uint64_t contacts, const T& now, const T& until) const {
    if (!in_epochs) return 0;
    const double made = static_cast<double>(contacts - contacts_before);
    const double passed = to_double(T((now - time_before) / epoch)), left = to_double(T((until - now) / epoch));
    return left * std::max(static_cast<double>(expected), passed > 0 ? made / passed : 0);
  }
  // After so many more contacts this epoch ends.
  std::uint64_t left(std::uint64_t contacts) const { return contacts < most_contacts ? most_contacts - contacts : 0; }
  // After so many contacts without any review. They are fewer than an epoch's most.
  void passed(std::uint64_t contacts, std::uint64_t active) {
    if (contacts >= next_poll) next_poll = contacts + std::min<std::uint64_t>(32 * active, 1 << 20);
    next_review = std::min(most_contacts, next_poll);
  }
  // The origin has moved to where the epoch ends, which is called `now` since.
  void epoch_ended(std::uint64_t contacts, const T& now, std::uint64_t active) {
    foresee(epoch, contacts - contacts_before, active);
    contacts_at_move = contacts;
    if (!in_epochs) return begin_reviews(contacts, now, active);
    begin_epoch(contacts, now, active);
    passed(contacts, active);
  }

  // Whether it can be that of a run of so many bodies which has made so many contacts, the last one at the given local
  // time and so long after the start, but for rounding. Who waits for a review too long could not be interrupted.
  bool follows(std::uint64_t contacts, const T& last_contact, const T& since_start, std::int64_t bodies) const {
    constexpr std::uint64_t most = std::uint64_t{1} << 50;  // in a year; 4096 times as many are an integer too
    return contacts < most && contacts_before <= contacts && contacts_at_move <= contacts && expected < most &&
           std::max({next_review, next_poll, most_contacts}) <=
               contacts + 4 * per_body_ * static_cast<std::uint64_t>(bodies) + 16 &&
           is_finite(since_start) && since_start > T(-1) && is_finite(last_contact) && is_finite(time_before) &&
           is_finite(epoch) && is_finite(epoch_end) &&
           (!in_epochs || (is_positive(epoch) && !(epoch_end < last_contact)));
  }
  static auto state(auto& self) {
    return std::tie(self.next_review, self.contacts_at_move, self.contacts_before, self.time_before, self.in_epochs,
                    self.epoch, self.epoch_end, self.expected, self.next_poll, self.most_contacts);
  }

 private:
  // How long the next epoch is to be where so many contacts have taken so long: as long as those that it is to have
  // should take, but not too many times as long, since a rate is not known well from a few contacts.
  void foresee(const T& took, std::uint64_t contacts, std::uint64_t active) {
    const auto aim = static_cast<std::int64_t>(per_body_ * active), made = static_cast<std::int64_t>(contacts);
    const std::int64_t most = made < 64 ? 64 : 4096;
    T next = aim > most * made ? T(took * T(most)) : T(took * T(aim) / T(made));
    if (!is_positive(next)) next = epoch / T(64);  // no time has passed
    in_epochs = is_positive(next);
    epoch = next;
    expected = static_cast<std::uint64_t>(std::min(most * std::max<std::int64_t>(made, 1), aim));
  }
  void begin_reviews(std::uint64_t contacts, const T& now, std::uint64_t active) {
    contacts_before = contacts;
    time_before = now;
    next_review = contacts + std::min(32 * active + 16, active * active / 8 + 1);
  }
  void begin_epoch(std::uint64_t contacts, const T& now, std::uint64_t active) {
    contacts_before = contacts;
    time_before = now;
    epoch_end = now + epoch;
    most_contacts = contacts + 4 * per_body_ * active + 16;
  }

  bool may_collapse_;
  std::uint64_t per_body_;  // contacts in an epoch
};

}  // namespace cradle
