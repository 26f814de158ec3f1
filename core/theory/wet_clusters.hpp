// The two heaviest clusters of the late wet shock as heavy pistons in the stationary force of the other particles:
// "Dry and wet granular shock waves", section VI, equation (16),  M_i(t) x_i'' = F(x_i),  M_i(t) = m (1 + r_i t).
// Where they meet they go through each other or stick. The velocity of the clusters does not enter the force, and what
// they take up comes in with their own velocity, as the equation is printed.
// The force jumps at the edges of the zone. Steps of the integrator end there: they are cut where its dense output
// crosses an edge or the clusters meet, so that every step sees a smooth force. The integrator is passed in: a
// dense-output stepper with error control, as make_dense_output(absolute, relative, runge_kutta_dopri5) of
// Boost.Odeint. Samples are read off its dense output, so they never change the motion. In double: the model is no
// better than that.
#pragma once

#include "cradle/core/theory/wet_shock.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace cradle::theory {

/// A force in regions divided by increasing edges, smooth in each of them and a little beyond.
template <class F>
concept PiecewiseForce = requires(const F force, std::size_t region, double x) {
  { force.edges() } -> std::convertible_to<std::span<const double>>;
  { force(region, x) } -> std::same_as<double>;
};

/// Where two clusters meet: the wet rule decides (they pass if mu w^2/2 > E_loss, which it costs, else stick); they
/// pass freely, as if (16) were all there is; or they stick.
enum class Meeting { energy, pass, stick };

struct ClusterStart {
  double x, v, growth;  ///< growth: r_i, the mass is m (1 + r_i t)
};

struct ClusterRules {
  double mass = 1;  ///< m
  double loss = 0;  ///< E_loss, for Meeting::energy
  Meeting meeting = Meeting::energy;
  double length = 1, speed = 1;  ///< units in which the integrator sees x and v, and its absolute tolerance holds
};

struct Cluster {
  double mass, x, v;
};

struct ClusterMeeting {
  double time, x, closing_speed;
  double relative_energy;  ///< mu w^2/2 before it
  bool stuck;
};

/// x and v of the first and of the second cluster, in the units of the rules.
using ClusterState = std::array<double, 4>;

template <PiecewiseForce Force, class Stepper> class ClusterMotion {
 public:
  ClusterMotion(const Force& force, const ClusterRules& rules, const std::array<ClusterStart, 2>& start, double time,
                const Stepper& stepper)
      : force_(force), rules_(rules), stepper_(stepper), begin_(time), known_(time) {
    for (std::size_t i = 0; i < 2; ++i) {
      mass_[i] = {rules.mass, rules.mass * start[i].growth};
      state_[2 * i] = start[i].x / rules.length;
      state_[2 * i + 1] = start[i].v / rules.speed;
      settle(i, time);
    }
    first_is_left_ = start[0].x < start[1].x || (start[0].x == start[1].x && start[0].v < start[1].v);
    stepper_.initialize(state_, begin_, 1e-3 * rules.length / rules.speed);
  }

  /// Advances to time t, not before the last requested one: the state after all meetings at times <= t.
  void advance(double t) {
    while (event_ ? t >= known_ : t > known_)
      if (event_)
        meet_event();
      else
        step();
    now_ = t;
  }

  /// The first and the second cluster now; once they have stuck, the first is both and there is no second.
  Cluster first() const { return cluster(0); }
  std::optional<Cluster> second() const { return merged_ ? std::nullopt : std::optional(cluster(1)); }
  bool first_is_left() const { return first_is_left_; }
  const std::vector<ClusterMeeting>& meetings() const { return meetings_; }

 private:
  enum class Kind { first_leaves, second_leaves, meeting };
  struct Event {
    double time;
    Kind kind;
  };
  struct Mass {
    double initial, rate;
    double at(double t) const { return initial + rate * t; }
  };

  Cluster cluster(std::size_t i) const {
    const ClusterState y = state_at(now_);
    return {mass_[i].at(now_), y[2 * i] * rules_.length, y[2 * i + 1] * rules_.speed};
  }

  bool moves(std::size_t i) const { return !pinned_[i] && !(merged_ && i == 1); }

  ClusterState state_at(double t) const {
    if (t == begin_) return state_;
    ClusterState y;
    stepper_.calc_state(t, y);
    return y;
  }

  void derivative(const ClusterState& y, ClusterState& dydt, double t) const {
    for (std::size_t i = 0; i < 2; ++i) {
      dydt[2 * i] = moves(i) ? y[2 * i + 1] * rules_.speed / rules_.length : 0;
      dydt[2 * i + 1] = moves(i) ? force_(region_[i], y[2 * i] * rules_.length) / (mass_[i].at(t) * rules_.speed) : 0;
    }
  }

  void step() {
    state_ = state_at(known_);
    begin_ = known_;
    stepper_.do_step([this](const ClusterState& y, ClusterState& dydt, double t) { derivative(y, dydt, t); });
    const double end = stepper_.current_time();
    event_.reset();
    for (std::size_t i = 0; i < 2; ++i)
      if (moves(i))
        search_for(
            i == 0 ? Kind::first_leaves : Kind::second_leaves, end,
            [&](const ClusterState& y) { return outside(i, y); }, [&](const ClusterState& y) { return y[2 * i + 1]; });
    if (!merged_)
      search_for(
          Kind::meeting, end, [&](const ClusterState& y) { return first_is_left_ ? y[0] - y[2] : y[2] - y[0]; },
          [&](const ClusterState& y) { return y[1] - y[3]; });
    known_ = event_ ? event_->time : end;
  }

  // By how much cluster i is out of its region.
  double outside(std::size_t i, const ClusterState& y) const {
    const auto edges = force_.edges();
    const double x = y[2 * i];
    double most = -std::numeric_limits<double>::infinity();
    if (region_[i] > 0) most = edges[region_[i] - 1] / rules_.length - x;
    if (region_[i] < edges.size()) most = std::max(most, x - edges[region_[i]] / rules_.length);
    return most;
  }

  // Notes the first time in this step at which `excess` becomes positive, if that is before the event noted so far.
  // `rate` vanishes where excess has its extremum: a step may cross and come back.
  template <class Excess, class Rate> void search_for(Kind kind, double end, Excess&& excess, Rate&& rate) {
    const auto crossed = [&](double t) { return excess(state_at(t)) > 0; };
    const bool rising = rate(state_at(begin_)) > 0;
    double from = begin_;
    if ((rate(state_at(end)) > 0) != rising) {
      const double turn = first_time(begin_, end, [&](double t) { return (rate(state_at(t)) > 0) != rising; });
      if (crossed(turn))
        end = turn;
      else
        from = turn;
    }
    if (!crossed(end)) return;
    const double time = first_time(from, end, crossed);
    if (!event_ || time < event_->time) event_ = Event{time, kind};
  }

  // Bisection to the last bit: false at (or after) `low`, true at `high`.
  template <class Condition> static double first_time(double low, double high, Condition&& condition) {
    if (condition(low)) return low;
    while (true) {
      const double middle = low + (high - low) / 2;
      if (!(low < middle && middle < high)) return high;
      (condition(middle) ? high : low) = middle;
    }
  }

  void meet_event() {
    const Event event = *event_;
    state_ = state_at(event.time);
    begin_ = known_ = event.time;
    event_.reset();
    if (event.kind == Kind::meeting) {
      meet(event.time);
    } else {
      const std::size_t i = event.kind == Kind::first_leaves ? 0 : 1;
      const double x = state_[2 * i] * rules_.length;  // beside the edge that it crosses
      const auto away = [x](double edge) { return magnitude(edge - x); };
      state_[2 * i] = *std::ranges::min_element(force_.edges(), {}, away) / rules_.length;
      settle(i, event.time);
    }
    stepper_.initialize(state_, begin_, stepper_.current_time_step());
  }

  void meet(double time) {
    const std::size_t left = first_is_left_ ? 0 : 1, right = 1 - left;
    const double m_left = mass_[left].at(time), m_right = mass_[right].at(time);
    const double x = (state_[0] + state_[2]) / 2;
    double& v_left = state_[2 * left + 1];
    double& v_right = state_[2 * right + 1];
    const double w = (v_left - v_right) * rules_.speed;
    const double reduced = m_left * (m_right / (m_left + m_right));
    const double energy = reduced * w * w / 2;
    const double critical = critical_closing_speed(rules_.loss, m_left, m_right);
    const bool stick = rules_.meeting == Meeting::stick || (rules_.meeting == Meeting::energy && !(w > critical));
    meetings_.push_back({time, x * rules_.length, w, energy, stick});
    state_[0] = state_[2] = x;
    if (stick) {
      state_ = {x, (m_left * v_left + m_right * v_right) / (m_left + m_right), x, 0};
      mass_[0] = {mass_[0].initial + mass_[1].initial, mass_[0].rate + mass_[1].rate};
      merged_ = true;
    } else if (rules_.meeting == Meeting::energy) {
      const double impulse = speed_lost(rules_.loss, w, critical) / rules_.speed;
      v_left -= impulse / m_left;
      v_right += impulse / m_right;
    }
    first_is_left_ = !first_is_left_;
    for (std::size_t i = 0; i < 2; ++i) settle(i, time);
  }

  // Which region cluster i is in. On an edge its velocity decides; if it has none, or too little to leave the edge by
  // more than rounding, the force does: where both sides push towards the edge it stays there for good.
  void settle(std::size_t i, double time) {
    const double x = state_[2 * i];
    const auto edges = force_.edges();
    pinned_[i] = false;
    region_[i] = 0;
    while (region_[i] < edges.size() && edges[region_[i]] / rules_.length < x) ++region_[i];
    const std::size_t below = region_[i];
    if (below == edges.size() || edges[below] / rules_.length != x) return;
    double& v = state_[2 * i + 1];
    const double push_left = force_(below, edges[below]), push_right = force_(below + 1, edges[below]);
    const double speed = v * rules_.speed;
    const double rounding =
        4 * std::numeric_limits<double>::epsilon() * std::max(rules_.length, magnitude(edges[below]));
    const double reach = std::min(push_left, -push_right) * rounding;
    if (push_left > 0 && push_right < 0 && !(mass_[i].at(time) * speed * speed / 2 > reach)) {
      v = 0;
      pinned_[i] = true;
    } else if (v > 0 || (v == 0 && push_right > 0)) {
      ++region_[i];
    }
  }

  Force force_;
  ClusterRules rules_;
  Stepper stepper_;
  std::array<Mass, 2> mass_{};
  ClusterState state_{};  // at begin_, where the present step or the motion after the last event starts
  double begin_, known_;  // the motion is known from begin_ to known_
  double now_ = begin_;
  std::optional<Event> event_;  // at known_
  std::array<std::size_t, 2> region_{};
  std::array<bool, 2> pinned_{};
  bool first_is_left_ = true, merged_ = false;
  std::vector<ClusterMeeting> meetings_;
};

}  // namespace cradle::theory
