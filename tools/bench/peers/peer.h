// What the peer programs share: they read and write meshes as `cellocut` does, with its exit codes.
#pragma once

#include <functional>
#include <string>

#include "cellocut/mesh/triangle_soup.h"

namespace CLI {
class App;
}

namespace cellocut::peers {

// The diagonal of the box of the points that triangles use. Precondition: a mesh with faces.
double box_diagonal(const TriangleSoup& mesh);

// Parses `input` and `-o`, reads, works, writes. `arguments` adds the program's own options.
// Returns the exit code: 0 done, 2 wrong usage, 3 unreadable input, 4 an empty result, 6 out of
// memory.
int run_peer(int argc, char** argv, const std::string& name, const std::string& what,
             const std::function<void(CLI::App&)>& arguments,
             const std::function<TriangleSoup(const TriangleSoup&)>& work);

}  // namespace cellocut::peers
