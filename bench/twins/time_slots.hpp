#pragma once
// The best of the conventional engines: neighbours as gaps, as in Cradle, and a flat table of time slots for the next
// collisions. Each slot is a list that is searched from end to end (a calendar queue; R. Brown 1988, doi
// 10.1145/63039.63045). A slot holds about two collisions; its width is adapted as the pace of collisions changes. The
// table has one slot for every one or two gaps, so that few entries are further ahead than one round.

#include <cstdint>
#include <vector>

#include "queues.hpp"

namespace twins {

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

}  // namespace twins
