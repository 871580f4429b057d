#pragma once
// Bars with intervals, for benches: a drawing in the page, without scripts.

#include <span>
#include <string>

#include "report/statistics.hpp"

namespace outrider::report {

struct Bar {
  std::string label;   ///< below the bar; broken into lines behind '+'
  double value = 0.0;  ///< >= 0; NaN leaves a gap
  Interval interval;   ///< of the value; NaN draws none
};

/// An SVG of upright bars on an axis from 0, the greatest value at the top. `title` with the unit stands above it.
std::string bar_chart(const std::string& title, std::span<const Bar> bars);

}  // namespace outrider::report
