// Writes one problem of each family that does not come from meshes, as .max and .bbk.
//
//   make_families NODES SEED FOLDER
#include <cstdio>
#include <cstdlib>
#include <string>

#include "cellocut/base/atomic_file.h"
#include "cellocut/base/errors.h"
#include "cellocut/cut/problem_file.h"
#include "support/cut_families.h"

namespace {

void save(const std::string& path, const std::string& bytes) {
  cellocut::AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace

int main(int argc, char** argv) {
  const long nodes = argc == 4 ? std::atol(argv[1]) : 0;
  if (nodes < 64 || nodes > 100'000'000) {
    std::fprintf(stderr, "usage: make_families NODES SEED FOLDER    (64 to 100000000 nodes)\n");
    return 2;
  }
  try {
    const std::uint64_t seed = std::strtoull(argv[2], nullptr, 10);
    for (const auto& [name, problem] :
         cellocut::testing::cut_families(static_cast<std::uint32_t>(nodes), seed)) {
      const std::string path = std::string(argv[3]) + "/" + name + "_" + argv[1] + "_" + argv[2];
      save(path + ".max", cellocut::encode_dimacs(problem));
      save(path + ".bbk", cellocut::encode_bbk(problem));
      std::printf("%s.max: %zu nodes, %zu edges\n", path.c_str(), problem.node_count(),
                  problem.edges.size());
    }
  } catch (const cellocut::Error& error) {
    std::fprintf(stderr, "make_families: %s\n", error.what());
    return 2;
  }
}
