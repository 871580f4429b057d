#pragma once
// Runs the program as a user would: as a child process, from an empty folder of its own, with a time limit.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace outrider::test {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Args = std::vector<std::string>;

inline std::string slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void spill(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

struct Outcome {
  int code = -1;  ///< exit code; -1: killed by a signal or by the time limit
  std::string out, err;
};

struct Conditions {
  fs::path stdout_to;                       ///< a device; empty: captured
  std::optional<rlim_t> most_bytes_a_file;  ///< as on a full disk: a write beyond it fails
  bool interrupt = false;                   ///< Ctrl-C once the first line of progress is there
  std::chrono::seconds limit{30};
};

/// Every file below `folder` with its bytes; directories end in '/' and are empty.
inline std::map<std::string, std::string> tree(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_directory())
      files[name + "/"];
    else
      files[name] = slurp(entry.path());
  }
  return files;
}

/// A test with an empty folder `dir` to work in; it is removed afterwards.
class SystemTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "outrider-system-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    root_ = pattern;
    dir = root_ / "work";
    fs::create_directory(dir);
  }
  void TearDown() override { fs::remove_all(root_); }

  /// `outrider args...` run in `cwd` (default: dir).
  Outcome run(const Args& args, const Conditions& conditions = {}, fs::path cwd = {}) const {
    if (cwd.empty()) cwd = dir;
    const fs::path out = conditions.stdout_to.empty() ? root_ / "stdout" : conditions.stdout_to, err = root_ / "stderr";
    spill(err, "");
    const pid_t child = fork();
    if (child == 0) become(args, conditions, cwd, out, err);
    Outcome outcome;
    outcome.code = wait_for(child, conditions, err);
    if (conditions.stdout_to.empty()) outcome.out = slurp(out);
    outcome.err = slurp(err);
    return outcome;
  }

  fs::path dir;

 private:
  [[noreturn]] static void become(const Args& args, const Conditions& conditions, const fs::path& cwd,
                                  const fs::path& out, const fs::path& err) {
    std::vector<char*> argv{const_cast<char*>(OUTRIDER_BINARY)};
    for (const std::string& arg : args) argv.push_back(const_cast<char*>(arg.c_str()));
    argv.push_back(nullptr);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    std::signal(SIGINT, SIG_DFL);
    if (conditions.most_bytes_a_file) {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{*conditions.most_bytes_a_file, *conditions.most_bytes_a_file};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (chdir(cwd.c_str()) == 0) execv(OUTRIDER_BINARY, argv.data());
    _exit(127);
  }

  static int wait_for(pid_t child, const Conditions& conditions, const fs::path& err) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + conditions.limit;
    bool interrupted = false;
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
      if (conditions.interrupt && !interrupted && slurp(err).find('%') != std::string::npos) {
        kill(child, SIGINT);
        interrupted = true;
      }
      if (Clock::now() > end) {
        ADD_FAILURE() << "still running after " << conditions.limit.count() << " s";
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
        return -1;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  fs::path root_;
};

inline Json result_of(const fs::path& run_folder) { return Json::parse(slurp(run_folder / "run.json")).at("result"); }

inline fs::path packaged_rawlog() {
  return "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
}

}  // namespace outrider::test
