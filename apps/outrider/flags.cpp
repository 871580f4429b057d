// The flags that verbs share.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>

#include "context.hpp"

namespace outrider::app {

CLI::Validator number_in(double low, double high) {
  return {[low, high](std::string& text) {
            double value = 0.0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool ok = error == std::errc() && end == text.data() + text.size() && value >= low && value <= high;
            return ok ? std::string() : fmt::format("expected a number from {} to {}, not '{}'", low, high, text);
          },
          fmt::format("in [{} - {}]", low, high)};
}

namespace {

/// CLI11 would read -1, and all that is too large, as the largest seed there is.
const CLI::Validator kWholeNumber{[](std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool ok = error == std::errc() && end == text.data() + text.size();
  return ok ? std::string() : fmt::format("expected a whole number from 0 to 2^64 - 1, not '{}'", text);
}, ""};

/// An empty name is most often a shell variable that was never set; the run would be lost.
const CLI::Validator kNotEmpty{[](std::string& text) {
  return text.empty() ? std::string("expected the name of a folder, not nothing") : std::string();
}, ""};

}  // namespace

void add_output_flags(CLI::App& verb, Context& ctx) {
  verb.add_flag("--json", ctx.json, "print the result as one JSON document on stdout");
  verb.add_flag("-q,--quiet", ctx.quiet, "no progress, no summary");
  verb.add_flag("-v,--verbose", ctx.verbose, "say more on stderr");
}

void add_work_flags(CLI::App& verb, Context& ctx) {
  add_output_flags(verb, ctx);
  verb.add_option("--out", ctx.out, "run folder to write; must not exist or be empty")->check(kNotEmpty)->type_name("DIR");
  verb.add_flag("--force", ctx.force, "replace an existing run folder");
  verb.add_option("--jobs", ctx.jobs, "threads; results do not depend on it")
      ->check(CLI::Range(1, 1024))->capture_default_str()->type_name("N");
}

void add_run_flags(CLI::App& verb, Context& ctx) {
  add_work_flags(verb, ctx);
  verb.add_option("--seed", ctx.seed, "every random choice comes from it")
      ->check(kWholeNumber)->capture_default_str()->type_name("N");
}

}  // namespace outrider::app
