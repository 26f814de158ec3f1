#pragma once
// A sink that stops a run at a given point, after any part of its work.

#include <csignal>
#include <functional>
#include <utility>

#include "cradle/tests/tools/program.hpp"
#include "cradle/tools/run/run.hpp"
#include "cradle/tools/store/run_files.hpp"
#include "cradle/tools/support/interrupt.hpp"

namespace cradle::tests {

// Passes all to the files, begins their journal at the first sample, and stops the run at a given point.
class Stopping : public tools::Sink {
 public:
  struct At {
    std::uint64_t collisions = ~std::uint64_t{0}, checks = ~std::uint64_t{0};
  };
  Stopping(tools::RunFiles& files, tools::Interrupt& interrupt, At at)
      : tools::Sink(tools::Tables::for_file), files_(files), interrupt_(interrupt), at_(at) {}

  void add(tools::Group&& rows) override { files_.add(std::move(rows)); }
  void end(std::vector<tools::Attribute>&& attributes, tools::RunEnd how) override {
    files_.end(std::move(attributes), how);
  }
  void count(std::uint64_t collisions) override {
    files_.count(collisions);
    if (collisions >= at_.collisions) interrupt_.note(SIGTERM);
  }
  void check_clock() override {
    files_.check_clock();
    if (++checks_ >= at_.checks) interrupt_.note(SIGTERM);
  }
  bool due() const override { return files_.due() || (checks_ == 1 && !begun_); }
  void keep(const tools::RunStatus& status, const std::function<void(StateSink&)>& save, tools::RunIs now) override {
    begun_ = true;
    files_.keep(status, save, now);
  }
  StateSource* loaded_from() override { return files_.loaded_from(); }

 protected:
  tools::RunFiles& files_;

 private:
  tools::Interrupt& interrupt_;
  At at_;
  std::uint64_t checks_ = 0;
  bool begun_ = false;
};

}  // namespace cradle::tests
