#pragma once
// Tables of figures for people: the same table as aligned text, HTML and CSV.

#include <string>
#include <vector>

namespace outrider::report {

/// A table whose cells are already written as text. The first column is a heading, the others are figures.
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`; "" = nothing to say
  std::string note;                            ///< below the table; may be empty
};

/// Title, aligned columns (the first one left, the others right), note; ends with a line feed. UTF-8.
std::string table_text(const Table& table);
/// <figure> with caption, table and note; everything escaped.
std::string table_html(const Table& table);

/// One field of a CSV file (RFC 4180): quoted where needed.
std::string csv_field(const std::string& text);

/// Number of columns that UTF-8 text takes on a terminal (code points; no wide characters expected).
std::size_t display_width(const std::string& text);

}  // namespace outrider::report
