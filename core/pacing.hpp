#pragma once
// How often the event loop looks after what is not a contact, and when the origin of time moves. Both follow from the
// history of contacts alone, never from who asks or how often.
//
// Regular reviews come after some 32 contacts per active body, sooner in a small zone. A move of the origin costs as
// much as a few contacts per gap: it is rare in a large zone and comes with every second contact in a few-body
// collapse.

#include <algorithm>
#include <cstdint>

#include "cradle/core/notice.hpp"
#include "cradle/core/real.hpp"

namespace cradle {

template <Real T> struct Pacing {
  explicit Pacing(const T& start) : time_before(start) {}

  std::uint64_t next_review = 1;       // contacts made when the next regular review is due
  std::uint64_t contacts_at_move = 0;  // contacts made when the origin moved last
  std::uint64_t contacts_before = 0;   // contacts made, and the local time, at the regular review or the move before
  T time_before;

  // After a contact at the given local time, with so many bodies active. The chain may ask for a move; at a regular
  // review there is one if bodies can collapse. If they merge instead, the origin moves only after many contacts, or
  // where these come at more than twice the rate, since the review before, that they have had since the last move.
  bool origin_moves(Notice notice, std::uint64_t contacts, const T& time, std::uint64_t active,
                    bool may_collapse) const {
    const std::uint64_t since_move = contacts - contacts_at_move;
    if (asks(notice, Notice::origin_must_move)) return true;
    if (asks(notice, Notice::origin_should_move) && 16 * since_move >= active) return true;
    if (contacts < next_review) return false;
    if (may_collapse || since_move >= 32 * active + 16) return true;
    return T(static_cast<std::int64_t>(2 * since_move)) * (time - time_before) <
           T(static_cast<std::int64_t>(contacts - contacts_before)) * time;
  }

  // After a review; `time` as it is called now. Reviews that a chain asked for (Notice::needs_slots) change nothing:
  // they depend on what is streamed.
  void reviewed(std::uint64_t contacts, const T& time, std::uint64_t active, bool moved) {
    if (moved) contacts_at_move = contacts;
    if (!moved && contacts < next_review) return;
    contacts_before = contacts;
    time_before = time;
    next_review = contacts + std::min(32 * active + 16, active * active / 8 + 1);
  }
};

}  // namespace cradle
