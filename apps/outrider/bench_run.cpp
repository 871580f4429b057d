// The runner of benches: threads and shards, with results that depend on neither.

#include <ctime>
#include <exception>
#include <iterator>
#include <mutex>
#include <thread>

#include "bench.hpp"

namespace outrider::app {
namespace {

/// CPU time of the whole process [s].
double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::vector<Trial> trials_of(const Experiment& experiment, std::uint64_t seed, Shard shard,
                             const std::atomic<bool>& interrupted) {
  std::vector<Trial> trials;
  int count = 0;
  for (const auto& c : experiment.design.cases)
    for (int number = 1; number <= c.trials; ++number, ++count)
      if (count % shard.of == shard.index - 1)
        for (const auto& a : experiment.design.algorithms)
          trials.push_back({c.name, number, a.name, trial_seed(seed, c.name, number), &interrupted});
  return trials;
}

/// Works off a list of trials with several threads.
class Workers {
 public:
  Workers(const Experiment& experiment, const std::vector<Trial>& trials, const std::atomic<bool>& interrupted,
          const std::function<void(std::size_t, std::size_t)>& progress)
      : experiment_(experiment), trials_(trials), interrupted_(interrupted), progress_(progress),
        outcomes_(trials.size()) {}

  std::vector<std::optional<Outcome>> run(int jobs) {
    {
      std::vector<std::jthread> threads;
      for (int k = 1; k < jobs; ++k) threads.emplace_back([this] { work(); });
      work();
    }
    if (error_) std::rethrow_exception(error_);
    return std::move(outcomes_);
  }

  bool complete() const { return done_ == trials_.size(); }

 private:
  void work() {
    while (!interrupted_ && !failed_) {
      const std::size_t k = next_++;
      if (k >= trials_.size()) return;
      try {
        auto outcome = experiment_.run(trials_[k]);
        const std::lock_guard lock(mutex_);
        if (interrupted_) return;  // it may have been cut short
        outcomes_[k] = std::move(outcome);
        progress_(++done_, trials_.size());
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failed_.exchange(true)) error_ = std::current_exception();
      }
    }
  }

  const Experiment& experiment_;
  const std::vector<Trial>& trials_;
  const std::atomic<bool>& interrupted_;
  const std::function<void(std::size_t, std::size_t)>& progress_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;  // guards what follows
  std::vector<std::optional<Outcome>> outcomes_;
  std::size_t done_ = 0;
  std::exception_ptr error_;
};

}  // namespace

std::uint64_t trial_seed(std::uint64_t seed, const std::string& case_name, int number) {
  std::uint64_t z = 0xCBF29CE484222325U;  // FNV-1a over the name, then splitmix64 with the numbers
  for (const char c : case_name) z = (z ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  z ^= seed * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(number) * 0xD1B54A32D192ED03U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

report::BenchResult run_experiment(const Experiment& experiment, std::uint64_t seed, int jobs, Shard shard,
                                   const std::atomic<bool>& interrupted,
                                   const std::function<void(std::size_t, std::size_t)>& progress) {
  const std::vector<Trial> trials = trials_of(experiment, seed, shard, interrupted);
  const double cpu_begin = cpu_seconds();
  Workers workers(experiment, trials, interrupted, progress);
  const auto outcomes = workers.run(experiment.serial ? 1 : jobs);
  report::BenchResult result;
  result.design = experiment.design;
  result.seed = seed;
  if (shard.of > 1) result.shard = std::to_string(shard.index) + "/" + std::to_string(shard.of);
  result.interrupted = !workers.complete();
  result.timing["cpu_s"] = cpu_seconds() - cpu_begin;
  std::vector<report::BenchRow> rows;  // of one trial
  for (std::size_t k = 0; k < trials.size(); ++k) {
    if (outcomes[k])
      rows.push_back({trials[k].case_name, trials[k].number, trials[k].algorithm, outcomes[k]->metrics, outcomes[k]->extra});
    if (k + 1 < trials.size() && trials[k + 1].case_name == trials[k].case_name && trials[k + 1].number == trials[k].number)
      continue;
    if (experiment.complete) experiment.complete(rows);
    std::move(rows.begin(), rows.end(), std::back_inserter(result.rows));
    rows.clear();
  }
  return result;
}

}  // namespace outrider::app
