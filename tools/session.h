// What every subcommand shares: threads, verbosity, progress, interruption.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/mesh_file.h"

namespace CLI {
class App;
}

namespace cellocut::tools {

// Options that every subcommand takes.
struct CommonOptions {
  int threads = 0;  // 0: as many as the machine has
  bool quiet = false;
  bool verbose = false;
  std::string json;  // where the report goes; empty: nowhere

  void add_to(CLI::App& command);
};

// Progress on a terminal (a bar on standard error with the stage's name, and how much of it is done
// where the stage tells), stage names with --verbose, and Ctrl-C as cancellation.
class TerminalObserver : public Observer {
 public:
  explicit TerminalObserver(const CommonOptions& options);
  ~TerminalObserver() override;
  TerminalObserver(const TerminalObserver&) = delete;
  TerminalObserver& operator=(const TerminalObserver&) = delete;

  void stage(std::string_view name) override;
  void progress(double done) override;
  [[nodiscard]] bool cancelled() const override;
  // Takes the bar away, so that other lines can be printed.
  void clear();

 private:
  void draw();

  bool bar_;
  bool lines_;
  std::mutex drawing_;
  std::string name_;  // of the stage
  int stages_ = 0;    // begun
  int percent_ = 0;   // of the stage
  bool drawn_ = false;
};

// Limits the number of threads for as long as it lives.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;
  [[nodiscard]] int threads() const { return threads_; }

 private:
  struct Control;
  std::unique_ptr<Control> control_;
  int threads_;
};

// From here on the first Ctrl-C (or SIGTERM) asks for cancellation, the second ends the program at
// once (temporary files are removed), and a file size limit is an error of a write instead of a
// signal.
void install_signal_handlers();

// Errors: UsageError where a file could not be created beside a path, before the work and not after
// it, or where it is the same file as another one or as one of the inputs. Empty paths and "-" are
// fine.
void require_writable(const std::vector<std::string>& paths,
                      const std::vector<std::string>& inputs = {});

// Errors: UsageError where the folder is not there and cannot be made, or nothing can be put into
// it. An empty path is fine.
void require_folder(const std::string& path);

// read_mesh() for a path of the command line; `format` is empty where its name tells it.
// Errors: as read_mesh(); InputError for a directory, whatever its name.
TriangleSoup read_input(const std::string& path, const std::string& format = {});

// Whether a file's name ends so, in small letters or capitals.
bool has_ending(std::string path, std::string_view ending);

// Writes text through AtomicFile.
void write_text(const std::string& path, const std::string& text);

}  // namespace cellocut::tools
