#include "report/html.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <regex>

#include "records.hpp"
#include "report/comparison.hpp"
#include "report/figures.hpp"
#include "report/metrics.hpp"
#include "report/page_data.hpp"

namespace outrider::report {
namespace {

std::span<const std::uint8_t> bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// What the browser does: base64, then gunzip.
std::string unpacked(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string zipped;
  unsigned word = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = (word << 6U) | static_cast<unsigned>(kDigits.find(c));
    if ((bits += 6) >= 8) zipped += static_cast<char>((word >> (bits -= 8)) & 255U);
  }
  std::string out(1 << 16, '\0');
  z_stream stream{};
  inflateInit2(&stream, 15 + 16);
  stream.next_in = reinterpret_cast<Bytef*>(zipped.data());
  stream.avail_in = static_cast<uInt>(zipped.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

Json data_of(const std::string& html) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = html.find(open) + open.size();
  return Json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(Html, Base64OfRfc4648) {
  EXPECT_EQ(base64(bytes("")), "");
  EXPECT_EQ(base64(bytes("f")), "Zg==");
  EXPECT_EQ(base64(bytes("fo")), "Zm8=");
  EXPECT_EQ(base64(bytes("foo")), "Zm9v");
  EXPECT_EQ(base64(bytes("foob")), "Zm9vYg==");
  EXPECT_EQ(base64(bytes("fooba")), "Zm9vYmE=");
  EXPECT_EQ(base64(bytes("foobar")), "Zm9vYmFy");
}

TEST(Html, LayersArriveAsTheyWere) {
  const RunRecord record = small_record();
  const Json data = data_of(report_html(record));
  EXPECT_EQ(unpacked(data["map"]["state"]), std::string({1, 1, 1, 2, 1, 1, 0, 0}));
  const std::string since = unpacked(data["map"]["known_since"]);
  ASSERT_EQ(since.size(), 16U);
  EXPECT_EQ(since.substr(0, 4), std::string({2, 0, 0, 0})) << "little endian";
  EXPECT_EQ(since.substr(12), "\xff\xff\xff\xff");
  EXPECT_EQ(unpacked(data["map"]["seen"]), std::string({1, 2, 2, 1, 1, 1, 0, 0}));
  EXPECT_EQ(count(unpacked(data["events"]["packed"]), "\n"), 1U);
  EXPECT_EQ(data["robots"][1]["path"]["y"], Json::parse("[150, 25]")) << "centimetres";
}

TEST(Html, FetchesNothing) {
  const std::string page = report_html(small_record());
  const std::regex fetch(R"((src|href)\s*=\s*["'])");
  const std::string without_library = page.substr(0, page.find("<script>"));
  EXPECT_FALSE(std::regex_search(without_library, fetch));
  EXPECT_EQ(page.find("<link"), std::string::npos);
  EXPECT_EQ(page.find("@import"), std::string::npos);
  EXPECT_EQ(page.find("url("), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos) << "and the browser is told to enforce it";
  EXPECT_NE(page.find("Chart.js v3"), std::string::npos) << "the library is inside, with its licence";
  EXPECT_EQ(page.find("{{"), page.find("{{", page.find("<script>"))) << "no placeholder is left";
}

TEST(Html, NoWallClockFigureIsInIt) {
  RunRecord record = small_record();
  const std::string page = report_html(record);
  record.timing = {{"wall_s", 123456.0}};
  EXPECT_EQ(report_html(record), page);
}

TEST(Html, HostileNamesStayText) {
  const std::string evil = "</script><script>alert(1)</script><!--\"'&{{data}}";
  RunRecord record = small_record();
  const std::string harmless = report_html(record);
  record.robots[0].spec.name = evil;
  record.world["name"] = evil;
  record.coordinator = evil;
  record.comms = evil;
  record.command.push_back(evil);
  record.configuration[evil] = evil;
  record.events[0]["robot"] = evil;
  record.result["left"][0]["why"] = evil;
  record.result["status"] = evil;
  const std::string page = report_html(record);
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(count(page, "<script"), count(harmless, "<script"));
  EXPECT_EQ(count(page, "</script"), count(harmless, "</script"));
  EXPECT_EQ(count(page, "<!--"), count(harmless, "<!--"));
  EXPECT_EQ(data_of(page)["robots"][0]["name"], evil);
}

TEST(Html, BytesThatAreNoUtf8AreReplaced) {
  RunRecord record = small_record();
  record.command.push_back("caf\xe9.log");
  record.events[0]["robot"] = "\xff";
  EXPECT_NO_THROW(report_html(record));
  EXPECT_NO_THROW(Json::parse(to_text(run_json(record))));
}

TEST(Html, AnEmptyRecordGivesAPage) { EXPECT_NE(report_html({}).find("</html>"), std::string::npos); }

TEST(Html, CommandSurvivesTheShell) {
  EXPECT_EQ(shell_command({"outrider", "explore", "--until", "0.95"}), "outrider explore --until 0.95");
  EXPECT_EQ(shell_command({"a b", "", "it's", "$HOME"}), "'a b' '' 'it'\\''s' '$HOME'");
  EXPECT_NE(report_html(small_record()).find("--out &#39;it&#39;\\&#39;&#39;s here&#39;"), std::string::npos);
}

TEST(Figures, VerdictInWords) {
  Json run = run_json(small_record());
  EXPECT_EQ(verdict(run), "2 robots explored 75.0 % of 8.0 m² in 1.0 s; what is left could not be reached.");
  run["result"]["status"] = "explored";
  run["team"].erase(0);
  EXPECT_EQ(verdict(run), "1 robot explored 75.0 % of 8.0 m² in 1.0 s.");
  run["result"] = Json{{"scans", 910}, {"duration_s", 2691.0}, {"explored_m2", 480.25}};
  EXPECT_EQ(verdict(run), "910 scans of 1 robot over 2691.0 s mapped 480.2 m².");
}

TEST(Figures, TableIsAlignedAndLeavesOutWhatNobodyKnows) {
  const std::vector<Json> runs{Json{{"result", {{"status", "explored"}, {"time_s", 12.25}}}},
                               Json{{"result", {{"status", "timeout"}, {"competitive_ratio", 1.5}}}}};
  const std::vector<std::string> names{"one", "two"};
  EXPECT_EQ(figure_table(figure_rows(runs), names),
            "                        one      two\n"
            "status             explored  timeout\n"
            "exploration time     12.2 s        -\n"
            "competitive ratio         -     1.50\n");
}

TEST(Figures, FieldsOfAnotherTypeCountAsUnknown) {
  const std::vector<Json> runs{Json::parse(R"({"result": {"status": 3, "time_s": "fast", "overlap": [1],
      "path_m": {"a": "far"}, "left": 7, "explored_fraction": null, "share": 1}})")};
  EXPECT_TRUE(figure_rows(runs).empty());
}

TEST(Comparison, PageAndJson) {
  RunSummary one{"runs/one", "one<b>", run_json(small_record()), small_record().timeline}, two = one;
  two.name = "two";
  const std::vector<RunSummary> runs{one, two};
  const std::string page = comparison_html(runs);
  EXPECT_EQ(count(page, "one<b>"), 0U);
  EXPECT_EQ(data_of(page)["curves"].size(), 2U);
  EXPECT_EQ(data_of(page)["curves"][0]["fraction"], Json::parse("[0.25, 0.75]"));
  const Json json = comparison_json(runs);
  EXPECT_EQ(json["runs"][1]["result"]["status"], "unreachable_left");
}

}  // namespace
}  // namespace outrider::report
