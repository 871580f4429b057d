#pragma once
// Key figures of runs, in words and units.

#include <span>
#include <string>
#include <vector>

#include "report/run_record.hpp"

namespace outrider::report {

/// One line of a table of figures: what, and its value with units for each run ("" = not known).
struct FigureRow {
  std::string label;
  std::vector<std::string> values;
};

/// The key figures of runs given as documents of run.json, one column a run. Rows that no run knows are left out.
/// Fields of an unexpected type count as not known.
std::vector<FigureRow> figure_rows(std::span<const Json> runs);

/// "4 robots explored 99.8 % of 312.4 m² in 143.2 s." or, for a replay, "12345 scans over 300.0 s, ..."
std::string verdict(const Json& run);

/// Aligned columns, the first one left, the others right; with a header line when `names` are given. UTF-8.
std::string figure_table(std::span<const FigureRow> rows, std::span<const std::string> names);

}  // namespace outrider::report
