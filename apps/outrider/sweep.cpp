// `outrider sweep`: every combination of explore's settings, sharded, resumable, compared.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "bench.hpp"
#include "progress.hpp"
#include "report/run_folder.hpp"
#include "sweep_file.hpp"
#include "sweep_journal.hpp"
#include "world/error.hpp"

namespace outrider::app {
namespace {

namespace fs = std::filesystem;
using report::Json;

constexpr const char* kResultFile = "sweep.json";
constexpr const char* kJournalFile = "journal.jsonl";

struct Options {
  fs::path file;
  std::string shard;
  std::vector<std::string> merge;
};

/// One combination of settings: a case and an algorithm of the experiment.
struct Combination {
  std::string case_name, algorithm;
  ResolvedSettings settings;
  std::shared_ptr<const sim::World> world;
  std::uint64_t hash = 0;  ///< of everything that determines a run but the seed
};

std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = 0xCBF29CE484222325U) {
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  return hash;
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::uint64_t hash_of(const ResolvedSettings& settings, const sim::World& world) {
  std::uint64_t hash = fnv1a(OUTRIDER_VERSION "\n" + settings.text);
  const auto& cells = world.map.data();
  hash = fnv1a({reinterpret_cast<const char*>(cells.data()), cells.size() * sizeof(cells[0])}, hash);
  return settings.options.team_file.empty() ? hash : fnv1a(bytes_of(settings.options.team_file), hash);
}

std::string run_id(const Combination& c, std::uint64_t seed) {
  return fmt::format("{:016x}", fnv1a(fmt::format("{:016x} {}", c.hash, seed)));
}

std::string label(const std::pair<std::string, std::string>& setting) { return setting.first + '=' + setting.second; }

/// All combinations, the first axis slowest, the compared one left to `algorithm`.
std::vector<Combination> combinations(const SweepPlan& plan, const fs::path& file) {
  std::map<std::pair<std::string, std::optional<double>>, std::shared_ptr<const sim::World>> worlds;
  std::vector<Combination> all;
  std::vector<std::size_t> digits(plan.axes.size(), 0);
  for (bool more = true; more;) {
    Settings settings = plan.base;
    Combination c;
    for (std::size_t k = 0; k < digits.size(); ++k) {
      settings.emplace_back(plan.axes[k].first, plan.axes[k].second[digits[k]]);
      if (plan.axes[k].first == plan.compare) c.algorithm = settings.back().second;
      else c.case_name += (c.case_name.empty() ? "" : ", ") + label(settings.back());
    }
    if (c.case_name.empty()) c.case_name = "all";
    try {
      c.settings = resolve(settings);
      auto& world = worlds[{c.settings.options.world, c.settings.options.resolution}];
      if (!world) world = std::make_shared<const sim::World>(open_exploration_world(c.settings.options));
      c.world = world;
      check_exploration(c.settings.options, *world);
    } catch (const InputError& e) {
      throw InputError(fmt::format("{}: with {}, {}={}: {}", file.string(), c.case_name, plan.compare, c.algorithm, e.what()));
    }
    c.hash = hash_of(c.settings, *c.world);
    all.push_back(std::move(c));
    more = false;
    for (std::size_t k = digits.size(); k-- > 0 && !more;) {
      digits[k] = (digits[k] + 1) % plan.axes[k].second.size();
      more = digits[k] != 0;
    }
  }
  return all;
}

report::BenchDesign design_of(const SweepPlan& plan, const std::vector<Combination>& all) {
  report::BenchDesign d;
  d.bench = "sweep";
  for (const Combination& c : all)
    if (std::none_of(d.cases.begin(), d.cases.end(), [&](const auto& known) { return known.name == c.case_name; }))
      d.cases.push_back({c.case_name, c.world->name, static_cast<int>(plan.seeds.size())});
  for (const auto& [key, values] : plan.axes)
    if (key == plan.compare)
      for (const std::string& value : values) d.algorithms.push_back({value, key});
  d.metrics = {{"time_s", "s", 1},          {"time95_s", "s", 1},     {"mission_time_s", "s", 1, true, false},
               {"explored", "", 4, false},  {"path_m", "m", 1},       {"overlap", "", 3},
               {"interaction_s", "s", 1, true, false}, {"messages", "", 0, false}, {"bytes", "", 0, false, false}};
  d.references = {d.algorithms.front().name};
  Json base = Json::object(), axes = Json::object();
  for (const auto& [key, value] : plan.base) base[key] = value;
  for (const auto& [key, values] : plan.axes) axes[key] = values;
  d.options = {{"base", base}, {"axes", axes}, {"compare", plan.compare}, {"seeds", plan.seeds}};
  return d;
}

std::optional<double> number(const Json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

report::Metrics metrics_of(const Json& result) {
  const bool explored = result.at("status") == "explored";
  double path_m = 0.0;
  for (const auto& [name, metres] : result.at("path_m").items()) path_m += metres.get<double>();
  const Json& messages = result.at("messages");
  const Json& interactions = result.at("interactions");
  return {{"time_s", explored ? number(result.at("time_s")) : std::nullopt},
          {"time95_s", number(result.at("time_to").at("0.95"))},
          {"mission_time_s", explored ? number(result.at("mission_time_s")) : std::nullopt},
          {"explored", number(result.at("explored_fraction"))},
          {"path_m", path_m},
          {"overlap", number(result.at("overlap").at("fraction"))},
          {"interaction_s", number(interactions.at("time_s"))},
          {"messages", number(messages.at("sent"))},
          {"bytes", number(messages.at("bytes"))}};
}

/// A run that throws becomes a row that says so: the others go on.
Outcome run_one(const Combination& c, const std::string& id, std::uint64_t seed, const std::atomic<bool>& interrupted) {
  try {
    const report::RunRecord record = run_exploration(c.settings.options, *c.world, seed, false,
                                                     [&](double, double) { return !interrupted.load(); });
    const Json result = report::run_json(record)["result"];
    return {metrics_of(result), {{"id", id}, {"seed", seed}, {"status", result["status"]}}};
  } catch (const std::exception& e) {
    return {{}, {{"id", id}, {"seed", seed}, {"status", "error"}, {"error", e.what()}}};
  }
}

/// `journal` may be null: nothing is kept then.
Experiment experiment_of(const SweepPlan& plan, std::vector<Combination> combinations,
                         std::shared_ptr<SweepJournal> journal) {
  auto all = std::make_shared<const std::vector<Combination>>(std::move(combinations));
  Experiment e;
  e.design = design_of(plan, *all);
  e.run = [all, journal, seeds = plan.seeds](const Trial& trial) -> std::optional<Outcome> {
    const auto c = std::find_if(all->begin(), all->end(), [&](const Combination& candidate) {
      return candidate.case_name == trial.case_name && candidate.algorithm == trial.algorithm;
    });
    const std::uint64_t seed = seeds[static_cast<std::size_t>(trial.number - 1)];
    const std::string id = run_id(*c, seed);
    if (journal)
      if (auto known = journal->find(id)) return known;
    Outcome outcome = run_one(*c, id, seed, *trial.interrupted);
    if (journal && !*trial.interrupted) journal->append(id, outcome);
    return outcome;
  };
  return e;
}

/// The journal in --out: of an earlier, unfinished try, unless --force begins anew.
std::shared_ptr<SweepJournal> open_journal(const Context& ctx) {
  if (ctx.out.empty()) return nullptr;
  const fs::path file = ctx.out / kJournalFile;
  if (ctx.force || !fs::exists(file)) {
    report::check_out_dir(ctx.out, ctx.force);
    fs::create_directories(ctx.out);
    fs::remove(file);
  }
  auto journal = std::make_shared<SweepJournal>(file);
  if (journal->size() > 0 && !ctx.quiet)
    fmt::print(stderr, "outrider: {} runs are there from an earlier try\n", journal->size());
  return journal;
}

/// Says how many runs failed, and why the first one did.
void report_failures(const report::BenchResult& result, Context& ctx) {
  std::size_t failed = 0;
  const report::BenchRow* first = nullptr;
  for (const auto& row : result.rows)
    if (row.extra.value("status", "") == "error" && failed++ == 0) first = &row;
  if (first == nullptr) return;
  fmt::print(stderr, "outrider: {} of {} runs failed; the first ({}, {}, seed {}): {}\n", failed, result.rows.size(),
             first->case_name, first->algorithm, first->extra["seed"].dump(), first->extra["error"].get<std::string>());
  if (ctx.exit_code == kDone) ctx.exit_code = kAimMissed;
}

void run(const Options& o, Context& ctx) {
  const Shard shard = parse_shard(o.shard);
  const SweepPlan plan = read_sweep_file(o.file);
  std::vector<Combination> all = combinations(plan, o.file);  // before anything is written
  const Experiment experiment = experiment_of(plan, std::move(all), open_journal(ctx));
  Progress progress("sweep", ctx.quiet);
  report::BenchResult result =
      run_experiment(experiment, ctx.seed, ctx.jobs, shard, *ctx.interrupted, [&](std::size_t done, std::size_t runs) {
        progress.update(static_cast<double>(done) / static_cast<double>(runs), fmt::format("{} of {} runs", done, runs));
      });
  result.timing = Json::object();  // files of equal sweeps are equal
  show_result(result, kResultFile, ctx);
  report_failures(result, ctx);
}

/// Results of shards, as files or as the folders that hold them.
void merge(const Options& o, Context& ctx) {
  if (!ctx.out.empty()) report::check_out_dir(ctx.out, ctx.force);
  std::vector<std::string> files;
  for (const std::string& name : o.merge)
    files.push_back(fs::is_directory(name) ? (fs::path(name) / kResultFile).string() : name);
  const report::BenchResult result = merge_files(files);
  show_result(result, kResultFile, ctx);
  report_failures(result, ctx);
}

}  // namespace

void add_sweep(CLI::App& app, Context& ctx) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("sweep", "every combination of explore's settings, compared");
  auto* file = verb->add_option("SWEEP", o->file, "what to run (YAML, docs/sweeps.md)")->type_name("FILE");
  verb->add_option("--shard", o->shard, "run part i of n only")->type_name("i/n");
  verb->add_option("--merge", o->merge, "join the folders (or sweep.json files) of all shards")
      ->type_name("DIR...")->excludes(file);
  add_work_flags(*verb, ctx);
  verb->footer("With --out, a sweep that was stopped goes on where it was when the same command is given again.");
  verb->callback([o, &ctx] {
    if (!o->merge.empty()) return merge(*o, ctx);
    if (o->file.empty()) throw InputError("sweep: expected a sweep file, or --merge DIR...");
    run(*o, ctx);
  });
}

}  // namespace outrider::app
