#include "cradle/tools/record/measurements.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cradle::tools {

namespace {

constexpr auto& rows = Measurements::rows;

// Logarithmic spacing starts at this share of the run: six points per decade would need 36 for it.
constexpr double first_log_share = 1e-6;

}  // namespace

std::span<const MeasurementRow* const> measurement_rows() { return rows; }

std::size_t row_number(std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(rows, name, &MeasurementRow::name) - rows.begin());
}

DecimalColumn series_times(const Scene& scene) {
  const Series& series = scene.output.series;
  const Decimal &start = scene.run.start, &until = scene.run.until;
  DecimalColumn times;
  if (!series.times.empty()) {
    for (const Decimal& time : series.times) times.push_back(time.text);
    return times;
  }
  if (series.every) return decimals_by_step(start, *series.every, until);
  const std::uint64_t points = *series.points;
  const Decimal end = series.over.value_or(until);
  if (!(start < end)) {
    times.push_back(start.text);
  } else if (series.spacing == Spacing::linear) {
    times = decimals_by_parts(start, end, points - 1, until, scene.run.decimal_digits());
  } else {
    times.push_back(start.text);
    for (std::uint64_t k = 1;; ++k) {
      // Shares of the span are computed in double, so that the times are the same in every precision.
      const double part = static_cast<double>(k - 1) / static_cast<double>(std::max<std::uint64_t>(points - 2, 1));
      const auto share = fmt::format("{}", k + 1 == points ? 1. : std::pow(first_log_share, 1 - part));
      const Decimal time = decimal_between(start, end, Decimal(share));
      if (time > until) break;
      times.push_back(time.text);
    }
  }
  times.push_back(until.text);
  return times;
}

std::vector<Group> in_order(GrowingTables&& growing) {
  std::vector<Group> tables = std::move(growing.tables());
  const auto rank = [](const Group& table) {
    const std::string_view name = rounded_name(table.name);
    std::size_t place = 0;
    const auto is = [&](std::string_view of) {
      ++place;
      return !of.empty() && name.starts_with(of) && (name.size() == of.size() || name[of.size()] == '/');
    };
    const bool listed = std::any_of(rows.begin(), rows.end(),
                                    [&](const auto* row) { return is(row->name == row->at_end ? "" : row->name); }) ||
                        std::any_of(rows.begin(), rows.end(), [&](const auto* row) { return is(row->at_end); }) ||
                        is("collapse");
    return place + (listed ? 0 : 1) + (name == table.name ? 0 : 3 * rows.size());
  };
  std::stable_sort(tables.begin(), tables.end(), [&](const Group& a, const Group& b) { return rank(a) < rank(b); });
  return tables;
}

}  // namespace cradle::tools
