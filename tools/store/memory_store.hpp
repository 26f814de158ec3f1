// Keeps what a run records in memory, for a run that its caller holds (run/live_run.hpp). It asks for no checkpoint:
// the caller decides when to save one.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "cradle/tools/result/writer.hpp"
#include "cradle/tools/store/run_journal.hpp"
#include "cradle/tools/store/run_store.hpp"

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
  void keep(const RunStatus&, const std::function<void(StateWriter&)>&, RunIs) override {}
  StateReader* loaded_from() override { return nullptr; }

  /// The tables recorded so far, to be saved and loaded beside the state of the run.
  std::vector<Group>& tables() { return tables_.tables(); }
  /// Writes the result file; the tables stay.
  void write(const Result& end, const std::string& path) const {
    GrowingTables all;
    for (const std::vector<Group>* groups : {&tables_.tables(), &end.groups})
      for (const Group& rows : *groups) all.add(Group(rows));
    write_or_keep({end.attributes, std::move(all).in_order()}, path);
  }

 private:
  static constexpr std::uint64_t collisions_between_checks = 1 << 13;  // of the clock

  GrowingTables tables_;
  std::function<void()> poll_;
  std::uint64_t next_check_ = 0;
  std::chrono::steady_clock::time_point polled_ = std::chrono::steady_clock::now();
};

}  // namespace cradle::tools
