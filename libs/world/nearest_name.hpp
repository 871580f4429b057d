#pragma once

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace outrider {

/// Levenshtein distance. O(|a| |b|).
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

/// The names that `word` may have been meant to be, nearest first, at most three; all within a third of its length
/// or starting with it.
inline std::vector<std::string> nearest_names(std::string_view word, const std::vector<std::string>& names) {
  std::vector<std::pair<std::size_t, std::string>> near;
  for (const std::string& name : names) {
    const std::size_t d = edit_distance(word, name);
    if (d <= std::max<std::size_t>(2, word.size() / 3) || (!word.empty() && name.starts_with(word)))
      near.emplace_back(d, name);
  }
  std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> result;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, near.size()); ++i) result.push_back(near[i].second);
  return result;
}

/// ", did you mean 'a' or 'b'?" or, when nothing is near, "; known: a, b, c".
inline std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
  const auto near = nearest_names(word, names);
  std::string text = near.empty() ? "; known: " : "; did you mean ";
  const auto& shown = near.empty() ? names : near;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (i > 0) text += near.empty() ? ", " : (i + 1 == shown.size() ? " or " : ", ");
    text += near.empty() ? shown[i] : "'" + shown[i] + "'";
  }
  return text + (near.empty() ? "" : "?");
}

}  // namespace outrider
