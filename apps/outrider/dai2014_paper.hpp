#pragma once
// Internal to the bench dai2014: what the paper printed, and our figures in its layout.

#include <string>
#include <vector>

#include "report/bench_result.hpp"

namespace outrider::app {

/// The placement of the paper's figures 3 and 4 and of its table 1: number 10 of table 2.
inline constexpr int kDaiShown = 10;

/// Means of table 4 and areas of table 7, for the summary.
std::vector<report::PublishedFigure> dai2014_published();

/// Tables 1 to 7 and the paper's claims, published figures beside ours; tables whose rows are missing are left out.
std::vector<report::Table> dai2014_tables(const report::BenchResult& result);

/// Figures 3 (trajectories) and 4 (completion times) redrawn. HTML.
std::string dai2014_figures(const report::BenchResult& result);

}  // namespace outrider::app
