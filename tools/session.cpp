#include "tools/session.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

#include "cellocut/base/atomic_file.h"
#include "cellocut/base/errors.h"

namespace cellocut::tools {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_interrupt(int signal) {
  if (interrupted.exchange(true)) {
    AtomicFile::remove_all_temporaries();
    _exit(signal == SIGINT ? 130 : 128 + signal);
  }
}

constexpr int kStages = 13;  // of a remesh with default options, for the bar

namespace fs = std::filesystem;

// By name, as far as that can be told, or by what is there; a pipe or a terminal is no such file.
bool is_same_file(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == "-" || b == "-") return false;
  std::error_code unknown;
  if (fs::exists(a, unknown) && !fs::is_regular_file(a, unknown)) return false;
  return fs::equivalent(a, b, unknown) ||
         fs::weakly_canonical(a, unknown) == fs::weakly_canonical(b, unknown);
}

}  // namespace

void CommonOptions::add_to(CLI::App& command) {
  command.add_option("--threads", threads, "Number of threads; the result does not depend on it")
      ->check(CLI::Range(1, 1024))
      ->default_str("all");
  CLI::Option* quiet_flag = command.add_flag("--quiet", quiet, "No progress, no summary");
  command.add_flag("--verbose", verbose, "A line on standard error for every stage")
      ->excludes(quiet_flag);
  command.add_option("--json", json, "Write a report to this file ('-': standard output)");
}

TerminalObserver::TerminalObserver(const CommonOptions& options)
    : bar_(!options.quiet && !options.verbose && isatty(STDERR_FILENO) != 0),
      lines_(options.verbose) {}

TerminalObserver::~TerminalObserver() { clear(); }

void TerminalObserver::stage(std::string_view name) {
  if (lines_) fmt::print(stderr, "cellocut: {}\n", name);
  if (!bar_) return;
  const std::lock_guard lock(drawing_);
  name_ = name;
  percent_ = 0;
  draw();
  ++stages_;
}

void TerminalObserver::progress(double done) {
  if (!bar_) return;
  const std::unique_lock lock(drawing_, std::try_to_lock);
  const int percent = static_cast<int>(100 * std::clamp(done, 0.0, 1.0));
  if (!lock || percent <= percent_) return;
  percent_ = percent;
  draw();
}

void TerminalObserver::draw() {
  constexpr int kWidth = 24;
  const int filled = std::min(kWidth, kWidth * stages_ / kStages);
  const std::string share = percent_ > 0 ? fmt::format(" {} %", percent_) : "";
  fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {}{}", "", filled, "", kWidth - filled, name_,
             share);
  std::fflush(stderr);
  drawn_ = true;
}

bool TerminalObserver::cancelled() const { return interrupted.load(std::memory_order_relaxed); }

void TerminalObserver::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()) {
  control_ = std::unique_ptr<Control>(new Control{tbb::global_control(
      tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads_))});
}

ThreadLimit::~ThreadLimit() = default;

void install_signal_handlers() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

void require_writable(const std::vector<std::string>& paths,
                      const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (paths[i].empty()) continue;
    for (std::size_t j = 0; j < i; ++j) {
      if (paths[i] == "-" && paths[j] == "-") {
        throw UsageError("only one output can be standard output");
      }
      if (is_same_file(paths[i], paths[j])) {
        throw UsageError(paths[i] + ": two outputs cannot be the same file");
      }
    }
    for (const std::string& input : inputs) {
      if (is_same_file(paths[i], input)) {
        throw UsageError(paths[i] + ": an output cannot be the input; give it another name");
      }
    }
  }
  for (const std::string& path : paths) {
    if (path.empty() || path == "-") continue;
    std::error_code unknown;
    const bool is_descriptor = path.starts_with("/dev/") || path.starts_with("/proc/");
    if (fs::is_fifo(path, unknown) && !is_descriptor) {
      // Not opened: whoever reads it would take a probe for the whole.
      if (faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) {
        throw UsageError(path + ": cannot be written: " + std::generic_category().message(errno));
      }
      continue;
    }
    try {
      const AtomicFile probe(path);
    } catch (const OutputError& error) {
      throw UsageError(error.file() + ": " + error.what());
    }
  }
}

void require_folder(const std::string& path) {
  if (path.empty()) return;
  std::error_code unknown;
  fs::path place = fs::absolute(path).lexically_normal();
  while (!fs::exists(place, unknown) && place.has_relative_path()) place = place.parent_path();
  if (!fs::is_directory(place, unknown)) throw UsageError(path + ": not a folder");
  std::string probe = (place / ".cellocut-XXXXXX").string();
  if (mkdtemp(probe.data()) == nullptr) {
    throw UsageError(path + ": cannot be written into: " + std::generic_category().message(errno));
  }
  rmdir(probe.c_str());
}

TriangleSoup read_input(const std::string& path, const std::string& format) {
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) throw InputError("is a directory", path);
  std::optional<MeshFormat> named;
  if (!format.empty()) named = format_of_name(format);
  return read_mesh(path, named);
}

bool has_ending(std::string path, std::string_view ending) {
  std::transform(path.begin(), path.end(), path.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return path.ends_with(ending);
}

void write_text(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace cellocut::tools
