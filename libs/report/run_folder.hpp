#pragma once
// The run folder on disk: written whole or not at all, and read back for comparisons.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "report/run_record.hpp"

namespace outrider::report {

struct RunFolderOptions {
  bool force = false;  ///< write into a folder that is not empty; a run found there is replaced
};

/// To be called before the work starts. Throws InputError when `dir` is a file, cannot be created or written, or is
/// a directory with something in it (a left-over `.partial-*` does not count) and `force` is not given.
void check_out_dir(const std::filesystem::path& dir, bool force);

/// Writes run.json, timeline.csv, events.jsonl, trajectories/NAME.tum and report.html into a staging directory
/// `.partial-*` beside `dir` (inside it when `dir` is a mount point), lets `extra` add files that need other rooms
/// (maps), and moves everything into place at the end: with one rename when `dir` does not exist; otherwise an old
/// run.json goes first and the new one comes last. So a full disk or a kill leaves nothing that looks whole.
/// Throws std::runtime_error naming the file and the reason when writing fails, after removing the staging
/// directory; whatever `extra` throws passes through.
void write_run_folder(const RunRecord& record, const std::filesystem::path& dir, const RunFolderOptions& options,
                      const std::function<void(const std::filesystem::path& staging)>& extra);

/// The document of run.json, schema 1 (docs/file-formats.md).
Json run_json(const RunRecord& record);

/// What a comparison needs of a run folder.
struct RunSummary {
  std::filesystem::path dir;
  std::string name;                   ///< last part of the path
  Json run;                           ///< run.json
  std::vector<TimelineRow> timeline;  ///< empty when timeline.csv is missing
};

/// Reads `dir`/run.json and timeline.csv. Throws InputError naming the file and the key or line when a file is missing,
/// is no run of schema 1, or is broken.
RunSummary load_run(const std::filesystem::path& dir);

/// Writes a file whole or not at all: beside its place as `.partial-NAME`, then renamed. Throws std::runtime_error with
/// path and reason.
void write_file(const std::filesystem::path& path, std::string_view content);

}  // namespace outrider::report
