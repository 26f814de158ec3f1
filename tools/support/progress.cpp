#include "cradle/tools/support/progress.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace cradle::tools {

void notify(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string duration(double seconds) {
  if (!(seconds < 360000)) return "more than 100 h";
  const auto s = static_cast<long>(seconds + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  return s >= 3600 ? fmt::format("{} h {:02} min", s / 3600, s / 60 % 60)
                   : fmt::format("{} min {:02} s", s / 60, s % 60);
}

namespace {

constexpr double least_seconds = 2;       // of computing, before anything is predicted
constexpr double agreement = 1.5;         // of predictions made at different moments
constexpr std::size_t most_points = 512;  // then every second one is dropped

using Points = std::vector<std::pair<double, double>>;

// The simulated time after so many seconds, between points linearly.
double time_at(const Points& points, double seconds) {
  const auto after = std::lower_bound(points.begin(), points.end(), std::pair(seconds, 0.0),
                                      [](const auto& a, const auto& b) { return a.first < b.first; });
  if (after == points.begin()) return points.front().second;
  if (after == points.end()) return points.back().second;
  const auto before = after - 1;
  const double share = (seconds - before->first) / (after->first - before->first);
  return before->second + share * (after->second - before->second);
}

// The seconds of the whole run as they would have been predicted after `seconds`; nothing if the run did not advance.
std::optional<double> total(const Points& points, double seconds, double end) {
  const double begin = points.front().first, quarter = (seconds - begin) / 4;
  const std::array<double, 3> time{time_at(points, seconds - 2 * quarter), time_at(points, seconds - quarter),
                                   time_at(points, seconds)};
  if (!(time[0] < time[1] && time[1] < time[2])) return std::nullopt;
  const double earlier = quarter / (time[1] - time[0]), later = quarter / (time[2] - time[1]);
  const double slope = (later - earlier) / ((time[2] - time[0]) / 2), rest = end - time[2];
  // From the middle of the last quarter to the middle of the rest; a cost that falls is not extrapolated.
  const double cost = later + std::max(slope, 0.0) * ((time[2] - time[1]) + rest) / 2;
  return seconds + cost * rest;
}

int callers_socket() {
  const char* const number = std::getenv("CRADLE_PROGRESS_FD");
  return number == nullptr ? -1 : std::atoi(number);
}

}  // namespace

void TimeLeft::add(double seconds, double time) {
  if (!points_.empty() && !(seconds > points_.back().first && time >= points_.back().second)) return;
  points_.emplace_back(seconds, time);
  if (points_.size() < most_points) return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points_.size(); k += 2) points_[kept++] = points_[k];
  if (points_.size() % 2 == 0) points_[kept++] = points_.back();
  points_.resize(kept);
}

std::optional<double> TimeLeft::until(double end) const {
  if (points_.size() < 2) return std::nullopt;
  const double begin = points_.front().first, now = points_.back().first;
  if (now - begin < least_seconds) return std::nullopt;
  double least = 0, most = 0;
  for (const double share : {1.0, 0.75, 0.5}) {
    const auto found = total(points_, begin + share * (now - begin), end);
    if (!found) return std::nullopt;
    least = most > 0 ? std::min(least, *found) : *found;
    most = std::max(most, *found);
  }
  if (most > agreement * least) return std::nullopt;
  return std::max(*total(points_, now, end) - now, 0.0);
}

ProgressLine::ProgressLine(Show show)
    : socket_(callers_socket()), terminal_(socket_ < 0 && ::isatty(STDERR_FILENO) != 0), active_(show != Show::never),
      every_(terminal_ || socket_ >= 0 ? 0.2
             : show == Show::always    ? 10
                                       : 60) {}

ProgressLine::~ProgressLine() {
  if (drawn_ && terminal_) notify("\r\033[K");
}

std::optional<double> ProgressLine::due(Clock::time_point now) const {
  if (!active_) return std::nullopt;
  const double passed = std::chrono::duration<double>(now - last_).count();
  return passed < every_ ? std::nullopt : std::optional(passed);
}

void ProgressLine::draw(double share, const std::string& state) {
  if (socket_ >= 0) {  // a caller that does not read misses the line; one that has ended waits for nothing any more
    const std::string line = fmt::format("{:.4f}\t{}\n", share, state);
    if (::send(socket_, line.data(), line.size(), MSG_DONTWAIT | MSG_NOSIGNAL) < 0 && errno == EPIPE)
      std::raise(SIGTERM);
  } else if (terminal_) {
    constexpr int width = 30;
    const auto full = static_cast<int>(share * width);
    notify(fmt::format("\r\033[K[{:#<{}}{: <{}}] {}", "", full, "", width - full, state));
  } else {
    notify(state + "\n");
  }
  drawn_ = true;
  last_ = Clock::now();
}

Progress::Progress(Show show, double start, double until, bool predictable)
    : line_(show), start_(start), until_(until), predictable_(predictable) {
  left_.add(0, start);
}

void Progress::continue_from(double time, std::uint64_t collisions) {
  last_collisions_ = collisions;
  left_ = TimeLeft();
  left_.add(std::chrono::duration<double>(Clock::now() - started_).count(), time);
}

void Progress::report(double time, std::uint64_t collisions) {
  const auto due = line_.due();
  if (!due) return;
  left_.add(std::chrono::duration<double>(Clock::now() - started_).count(), time);
  const double share = until_ > start_ ? std::clamp((time - start_) / (until_ - start_), 0.0, 1.0) : 1.0;
  std::string state =
      fmt::format("t = {:.6g} of {:.6g}, {:.4g} collisions, {:.3g} million/s", time, until_,
                  static_cast<double>(collisions), static_cast<double>(collisions - last_collisions_) / *due * 1e-6);
  if (const auto seconds = left_.until(until_); seconds && predictable_)
    state += fmt::format(", {} left", duration(*seconds));
  line_.draw(share, state);
  last_collisions_ = collisions;
}

ReplicaProgress::ReplicaProgress(ProgressLine::Show show, std::uint64_t before, std::uint64_t total)
    : line_(show), before_(before), done_(before), total_(total) {}

void ReplicaProgress::done(std::uint64_t replicas) {
  const std::scoped_lock lock(mutex_);
  done_ += replicas;
  if (!line_.due()) return;
  const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  const double speed = static_cast<double>(done_ - before_) / passed;
  line_.draw(static_cast<double>(done_) / static_cast<double>(total_),
             fmt::format("{} of {} replicas, {:.3g}/s, {} left", done_, total_, speed,
                         speed > 0 ? duration(static_cast<double>(total_ - done_) / speed) : "?"));
}

}  // namespace cradle::tools
