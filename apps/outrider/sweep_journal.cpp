#include "sweep_journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "world/error.hpp"

namespace outrider::app {
namespace {

using report::Json;

Json to_json(const std::string& id, const Outcome& outcome) {
  Json metrics = Json::object();
  for (const auto& [name, value] : outcome.metrics) metrics[name] = value ? Json(*value) : Json();
  return {{"id", id}, {"metrics", metrics}, {"extra", outcome.extra}};
}

Outcome from_json(const Json& line) {
  Outcome outcome{{}, line.at("extra")};
  for (const auto& [name, value] : line.at("metrics").items())
    outcome.metrics.emplace_back(name, value.is_null() ? std::nullopt : std::optional(value.get<double>()));
  return outcome;
}

}  // namespace

SweepJournal::SweepJournal(const std::filesystem::path& file) : path_(file) {
  file_.reset(std::fopen(file.c_str(), "a"));
  if (!file_) throw InputError(fmt::format("{}: cannot write: {}", file.string(), std::strerror(errno)));
  if (flock(fileno(file_.get()), LOCK_EX | LOCK_NB) != 0)
    throw InputError(fmt::format("{}: another sweep is writing into this folder", file.string()));
  std::ifstream in(file);
  read({std::istreambuf_iterator<char>(in), {}});
}

void SweepJournal::read(const std::string& text) {
  std::size_t begin = 0;
  for (int number = 1;; ++number) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;
    const Json line = Json::parse(text.substr(begin, end - begin), nullptr, false);
    if (!line.is_object() || !line.contains("id") || !line.contains("metrics") || !line.contains("extra"))
      throw InputError(fmt::format("{}:{}: no run of a sweep; use --force to begin anew", path_.string(), number));
    outcomes_[line["id"]] = from_json(line);
    begin = end + 1;
  }
  if (begin < text.size() && ftruncate(fileno(file_.get()), static_cast<off_t>(begin)) != 0)
    throw std::runtime_error(fmt::format("{}: cannot write: {}", path_.string(), std::strerror(errno)));
}

std::optional<Outcome> SweepJournal::find(const std::string& id) const {
  const auto found = outcomes_.find(id);
  return found == outcomes_.end() ? std::nullopt : std::optional(found->second);
}

void SweepJournal::append(const std::string& id, const Outcome& outcome) {
  const std::string line = report::to_text(to_json(id, outcome)) + '\n';
  const std::lock_guard lock(mutex_);
  if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() || std::fflush(file_.get()) != 0)
    throw std::runtime_error(fmt::format("{}: cannot write: {}", path_.string(), std::strerror(errno)));
}

}  // namespace outrider::app
