#include "tools/bench/peers/peer.h"

#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <optional>

#include "cellocut/base/errors.h"
#include "cellocut/base/point.h"
#include "cellocut/mesh/mesh_file.h"
#include "tools/exit_code.h"

namespace cellocut::peers {

namespace {

struct Files {
  std::string input;
  std::string output;
  int threads = 1;
};

int work_on(const Files& files, const std::function<TriangleSoup(const TriangleSoup&)>& work) {
  const std::size_t threads = static_cast<std::size_t>(files.threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const TriangleSoup input = read_mesh(files.input);
  const std::optional<MeshFormat> format = format_of_path(files.output);
  if (!format) throw UsageError(files.output + ": write .obj, .off, .ply or .stl");
  const TriangleSoup output = work(input);
  if (output.empty()) throw GuaranteeError("the result is empty");
  write_mesh(output, files.output, *format);
  return tools::kDone;
}

}  // namespace

double box_diagonal(const TriangleSoup& mesh) {
  const Box3 box = bounding_box(mesh);
  return norm(box.high - box.low);
}

int run_peer(int argc, char** argv, const std::string& name, const std::string& what,
             const std::function<void(CLI::App&)>& arguments,
             const std::function<TriangleSoup(const TriangleSoup&)>& work) {
  CLI::App program{what};
  program.name(name);
  Files files;
  program.add_option("input", files.input, "Mesh: .obj .off .ply .stl")->required();
  program.add_option("-o,--output", files.output, "Surface: .obj .off .ply .stl")->required();
  program.add_option("--threads", files.threads, "Number of threads")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  arguments(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);
    tools::print_error(error.what());
    return tools::kUsage;
  }
  try {
    return work_on(files, work);
  } catch (const std::exception& error) {
    return tools::report_error(error, files.input);
  }
}

}  // namespace cellocut::peers
