#pragma once
// Files of a run that stop it at a given point, after any part of its work.

#include <csignal>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/support/interrupt.hpp"

namespace cradle::tests {

// Begins its journal at the first look at the clock, and stops the run at a given point.
class Stopping final : public tools::RunFiles {
 public:
  struct At {
    std::uint64_t collisions = ~std::uint64_t{0}, checks = ~std::uint64_t{0};
  };
  // `files`: as RunFiles takes them.
  template <class... Files>
  Stopping(tools::Interrupt& interrupt, At at, const Files&... files)
      : RunFiles(files...), interrupt_(interrupt), at_(at) {}

  void count(std::uint64_t collisions) override {
    RunFiles::count(collisions);
    if (collisions >= at_.collisions) interrupt_.note(SIGTERM);
  }
  void check_clock() override {
    RunFiles::check_clock();
    if (++checks_ >= at_.checks) interrupt_.note(SIGTERM);
  }
  bool due() const override { return RunFiles::due() || (checks_ == 1 && !begun_); }
  void keep(const tools::RunStatus& status, const std::function<void(StateSink&)>& save, tools::RunIs now) override {
    begun_ = true;
    RunFiles::keep(status, save, now);
  }

 private:
  tools::Interrupt& interrupt_;
  At at_;
  std::uint64_t checks_ = 0;
  bool begun_ = false;
};

}  // namespace cradle::tests
