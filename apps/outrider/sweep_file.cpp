#include "sweep_file.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

#include "explorer/yaml_reader.hpp"
#include "world/error.hpp"

namespace outrider::app {
namespace {

using explorer::YamlReader;

constexpr std::size_t kMostRuns = 10'000'000;

/// What may be set: explore's flags without the dashes, and its world.
std::vector<std::string> setting_names() {
  CLI::App verb;
  verb.set_help_flag();
  ExploreOptions o;
  add_explore_options(verb, o);
  std::vector<std::string> names{"world"};
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

std::vector<std::string> values(const YamlReader& reader, const YAML::Node& node, const std::string& key) {
  if (!node.IsSequence() || node.size() == 0) reader.fail(node, key + ": expected a list of values, as in [field, office]");
  std::vector<std::string> list;
  for (const YAML::Node& value : node) {
    list.push_back(reader.text(value, "a value of " + key));
    if (std::count(list.begin(), list.end(), list.back()) > 1) reader.fail(value, fmt::format("{}: '{}' twice", key, list.back()));
  }
  return list;
}

std::uint64_t seed(const YamlReader& reader, const YAML::Node& node) {
  std::uint64_t value = 0;
  if (!node.IsScalar() || node.Scalar().starts_with('-') || !YAML::convert<std::uint64_t>::decode(node, value))
    reader.fail(node, "seeds: expected a number of seeds, or a list of whole numbers from 0 to 2^64 - 1");
  return value;
}

std::vector<std::uint64_t> read_seeds(const YamlReader& reader, const YAML::Node& node) {
  std::vector<std::uint64_t> seeds;
  if (node.IsSequence()) {
    for (const YAML::Node& value : node) {
      seeds.push_back(seed(reader, value));
      if (std::count(seeds.begin(), seeds.end(), seeds.back()) > 1) reader.fail(value, "seeds: a seed that stands twice");
    }
  } else {
    const std::uint64_t n = seed(reader, node);
    if (n > kMostRuns) reader.fail(node, fmt::format("seeds: at most {}", kMostRuns));
    for (std::uint64_t k = 1; k <= n; ++k) seeds.push_back(k);
  }
  if (seeds.empty()) reader.fail(node, "seeds: expected at least one");
  return seeds;
}

void read_base(const YamlReader& reader, const YAML::Node& node, SweepPlan& plan) {
  if (!node.IsMap()) reader.fail(node, "base: expected settings of explore, as in {until: 0.95}");
  reader.known_keys(node, setting_names());
  for (const auto& pair : node) plan.base.emplace_back(pair.first.Scalar(), reader.text(pair.second, pair.first.Scalar()));
}

void read_axes(const YamlReader& reader, const YAML::Node& node, SweepPlan& plan) {
  if (!node.IsMap() || node.size() == 0) reader.fail(node, "axes: expected lists of settings, as in {coordinator: [daa, ea]}");
  reader.known_keys(node, setting_names());
  for (const auto& pair : node) {
    const std::string key = pair.first.Scalar();
    if (std::any_of(plan.base.begin(), plan.base.end(), [&](const auto& s) { return s.first == key; }))
      reader.fail(pair.first, fmt::format("{}: stands under base already", key));
    plan.axes.emplace_back(key, values(reader, pair.second, key));
  }
}

}  // namespace

SweepPlan read_sweep_file(const std::filesystem::path& path) {
  const YamlReader reader(path, "sweep file");
  const YAML::Node root = reader.load();
  if (!root.IsMap() || !root["axes"]) throw InputError(path.string() + ": expected 'axes: {setting: [values], ...}'");
  reader.known_keys(root, {"base", "axes", "compare", "seeds"});
  SweepPlan plan;
  if (root["base"]) read_base(reader, root["base"], plan);
  read_axes(reader, root["axes"], plan);
  std::vector<std::string> axes;
  for (const auto& axis : plan.axes) axes.push_back(axis.first);
  plan.compare = std::find(axes.begin(), axes.end(), "coordinator") != axes.end() ? "coordinator" : axes.back();
  if (root["compare"]) {
    plan.compare = reader.text(root["compare"], "compare");
    if (std::find(axes.begin(), axes.end(), plan.compare) == axes.end())
      reader.fail(root["compare"], fmt::format("compare: '{}' is no axis{}", plan.compare, suggestion(plan.compare, axes)));
  }
  if (root["seeds"]) plan.seeds = read_seeds(reader, root["seeds"]);
  std::size_t runs = plan.seeds.size();
  for (const auto& axis : plan.axes) runs *= axis.second.size();
  if (runs > kMostRuns) throw InputError(fmt::format("{}: more than {} runs", path.string(), kMostRuns));
  return plan;
}

ResolvedSettings resolve(const Settings& settings) {
  ResolvedSettings resolved;
  CLI::App verb;
  verb.set_help_flag();
  add_explore_options(verb, resolved.options);
  std::vector<std::string> args;  // CLI11 takes them last first
  for (const auto& [key, value] : settings)
    if (!value.empty()) args.push_back(key == "world" ? value : fmt::format("--{}={}", key, value));
  std::reverse(args.begin(), args.end());
  try {
    verb.parse(args);
  } catch (const CLI::ParseError& e) {
    throw InputError(e.what());
  }
  resolved.text = verb.config_to_str(true, false);
  return resolved;
}

}  // namespace outrider::app
