#include "cradle/tools/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace cradle::tools {

namespace {

std::string duration(double seconds) {
  if (!(seconds < 360000)) return "more than 100 h";
  const auto s = static_cast<long>(seconds + 0.5);
  return s >= 3600 ? fmt::format("{} h {:02} min", s / 3600, s / 60 % 60) : fmt::format("{}:{:02} min", s / 60, s % 60);
}

}  // namespace

Progress::Progress(Show show, double start, double until)
    : terminal_(::isatty(STDERR_FILENO) != 0), start_(start), until_(until), last_time_(start) {
  active_ = show == Show::always || (show == Show::on_terminal && terminal_);
}

Progress::~Progress() {
  if (drawn_ && terminal_) fmt::print(stderr, "\r\033[K");
}

void Progress::tell(double time, std::uint64_t contacts) {
  if (!active_) return;
  const auto now = Clock::now();
  const double passed = std::chrono::duration<double>(now - last_).count();
  if (passed < (terminal_ ? 0.2 : 10.0)) return;
  const double speed = (time - last_time_) / passed;
  speed_ = speed_ > 0 ? 0.7 * speed_ + 0.3 * speed : speed;
  const double share = until_ > start_ ? std::clamp((time - start_) / (until_ - start_), 0.0, 1.0) : 1.0;
  const std::string state =
      fmt::format("t = {:.6g} of {:.6g}, {:.4g} contacts, {:.3g} million/s, {} left", time, until_,
                  static_cast<double>(contacts), static_cast<double>(contacts - last_contacts_) / passed * 1e-6,
                  speed_ > 0 ? duration((until_ - time) / speed_) : "?");
  if (terminal_) {
    constexpr int width = 30;
    const auto full = static_cast<int>(share * width);
    fmt::print(stderr, "\r\033[K[{:#<{}}{: <{}}] {}", "", full, "", width - full, state);
    std::fflush(stderr);
  } else {
    fmt::print(stderr, "{}\n", state);
  }
  drawn_ = true;
  last_ = now;
  last_time_ = time;
  last_contacts_ = contacts;
}

}  // namespace cradle::tools
