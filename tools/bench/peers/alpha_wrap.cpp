// peer_alpha_wrap: CGAL's Alpha Wrap (Portaneri et al. 2022, "Alpha wrapping with an offset"), to
// be compared with. Degenerate triangles are left out of what it sees: its oracle refuses them.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <CLI/CLI.hpp>
#include <array>
#include <vector>

#include "cellocut/base/errors.h"
#include "tools/bench/peers/peer.h"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

struct Parameters {
  double alpha = 300;    // diagonal / alpha
  double offset = 1200;  // diagonal / offset
};

cellocut::TriangleSoup to_soup(const Mesh& mesh) {
  cellocut::TriangleSoup soup;
  soup.points.reserve(mesh.number_of_vertices());
  std::vector<std::uint32_t> index(mesh.num_vertices());
  for (const Mesh::Vertex_index v : mesh.vertices()) {
    index[v.idx()] = static_cast<std::uint32_t>(soup.points.size());
    const Point& p = mesh.point(v);
    soup.points.push_back({p.x(), p.y(), p.z()});
  }
  soup.triangles.reserve(mesh.number_of_faces());
  for (const Mesh::Face_index f : mesh.faces()) {
    cellocut::Triangle triangle{};
    std::size_t corner = 0;
    for (const Mesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f))) {
      triangle[corner++] = index[v.idx()];
    }
    soup.triangles.push_back(triangle);
  }
  return soup;
}

cellocut::TriangleSoup wrap(const cellocut::TriangleSoup& input, const Parameters& parameters) {
  std::vector<Point> points;
  points.reserve(input.points.size());
  for (const auto& p : input.points) points.emplace_back(p[0], p[1], p[2]);
  std::vector<std::array<std::size_t, 3>> faces;
  faces.reserve(input.triangles.size());
  for (const cellocut::Triangle& t : input.triangles) {
    if (!CGAL::collinear(points[t[0]], points[t[1]], points[t[2]])) {
      faces.push_back({t[0], t[1], t[2]});
    }
  }
  if (faces.empty()) throw cellocut::InputError("all triangles are degenerate");
  const double diagonal = cellocut::peers::box_diagonal(input);
  Mesh result;
  CGAL::alpha_wrap_3(points, faces, diagonal / parameters.alpha, diagonal / parameters.offset,
                     result);
  return to_soup(result);
}

}  // namespace

int main(int argc, char** argv) {
  Parameters parameters;
  return cellocut::peers::run_peer(
      argc, argv, "peer_alpha_wrap", "CGAL's Alpha Wrap of a mesh.",
      [&](CLI::App& program) {
        program
            .add_option("--alpha", parameters.alpha, "Alpha is the box's diagonal divided by this")
            ->check(CLI::PositiveNumber)
            ->capture_default_str();
        program
            .add_option("--offset", parameters.offset,
                        "The offset is the box's diagonal divided by this")
            ->check(CLI::PositiveNumber)
            ->capture_default_str();
      },
      [&](const cellocut::TriangleSoup& input) { return wrap(input, parameters); });
}
