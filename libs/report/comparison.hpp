#pragma once
// Key figures of one run, and several runs side by side: as text, JSON and a page.

#include <span>
#include <string>
#include <vector>

#include "report/run_folder.hpp"

namespace outrider::report {

/// One line of a table of figures: what, and its value in words and units for each run ("" = unknown).
struct FigureRow {
  std::string label;
  std::vector<std::string> values;
};

/// The key figures of runs given as documents of run.json, one column a run. Rows that no run knows are left out.
std::vector<FigureRow> figure_rows(std::span<const Json> runs);

/// "4 robots explored 99.8 % of 312.4 m² in 143.2 s (daa)."
std::string verdict(const Json& run);

/// Aligned columns, first column left, the others right; with a header line of `names` when there are several.
std::string figure_table(const std::vector<FigureRow>& rows, const std::vector<std::string>& names);

/// {"runs": [{"run": name, "coordinator", "seed", ..., "result": {...}}]}: the results side by side.
Json comparison_json(std::span<const RunSummary> runs);

/// A self-contained page: the table of figures and the coverage curves on one chart.
std::string comparison_html(std::span<const RunSummary> runs);

}  // namespace outrider::report
