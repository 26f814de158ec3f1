// Keeps what a run records in memory, for a run that its caller holds (run/live_run.hpp). It asks for no checkpoint:
// the caller decides when to save one.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "cradle/tools/result/growing_tables.hpp"
#include "cradle/tools/run/run_store.hpp"

namespace cradle::tools {

class MemoryStore final : public RunStore {
 public:
  /// `poll`, which may be empty, is called some times a second while the run computes.
  explicit MemoryStore(std::function<void()> poll) : poll_(std::move(poll)) {}

  void add(Group&& rows) override {
    if (!has_nothing(rows)) tables_.add(std::move(rows));
  }
  void count(std::uint64_t collisions) override {
    if (collisions < next_check_) return;
    next_check_ = collisions + collisions_between_checks;
    check_clock();
  }
  void check_clock() override {
    const auto now = std::chrono::steady_clock::now();
    if (!poll_ || now - polled_ < std::chrono::milliseconds(50)) return;
    polled_ = now;
    poll_();
  }
  bool due() const override { return false; }
  void keep(const RunStatus&, const std::function<void(StateSink&)>&, RunIs) override {}
  StateSource* loaded_from() override { return nullptr; }

  /// The tables recorded so far, to be saved and loaded beside the state of the run.
  std::vector<Group>& tables() { return tables_.tables(); }
  /// The whole result of a run that ended so; the tables stay.
  Result result(const Result& end) const {
    GrowingTables all;
    for (const std::vector<Group>* groups : {&tables_.tables(), &end.groups})
      for (const Group& rows : *groups) all.add(Group(rows));
    return {end.attributes, std::move(all).in_order()};
  }

 private:
  static constexpr std::uint64_t collisions_between_checks = 1 << 13;  // of the clock

  GrowingTables tables_;
  std::function<void()> poll_;
  std::uint64_t next_check_ = 0;
  std::chrono::steady_clock::time_point polled_ = std::chrono::steady_clock::now();
};

}  // namespace cradle::tools
