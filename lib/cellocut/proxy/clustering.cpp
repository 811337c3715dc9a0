#include "cellocut/proxy/clustering.h"

#include <utility>
#include <vector>

#include "cellocut/proxy/departure.h"
#include "cellocut/proxy/vertex_clusters.h"

namespace cellocut {

namespace {

// Faces in ascending order, and how far each departs.
struct Measured {
  std::vector<Triangle> faces;
  std::vector<Departure> worst;
};

// Takes over what was measured before.
Measured measure(std::vector<Triangle> faces, const Measured& before, const TriangleSoup& surface,
                 const SparseField& phi) {
  std::vector<Departure> worst(faces.size());
  std::vector<Triangle> fresh;
  std::vector<std::size_t> place;
  std::size_t known = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    while (known < before.faces.size() && before.faces[known] < faces[f]) ++known;
    if (known < before.faces.size() && before.faces[known] == faces[f]) {
      worst[f] = before.worst[known];
    } else {
      fresh.push_back(faces[f]);
      place.push_back(f);
    }
  }
  const std::vector<Departure> measured = measure_faces(surface.points, fresh, phi);
  for (std::size_t n = 0; n < place.size(); ++n) worst[place[n]] = measured[n];
  return {std::move(faces), std::move(worst)};
}

}  // namespace

Refinement cluster_vertices(const TriangleSoup& surface, double removed_share,
                            const SparseField& phi, double tolerance, Observer& observer) {
  VertexClusters clusters(surface, tolerance, observer);
  clusters.make(removed_share);
  Measured measured = measure(clusters.faces(), {}, surface, phi);
  const std::size_t faces_at_first = measured.faces.size();
  while (true) {
    observer.check();
    std::vector<std::uint32_t> corners;
    for (std::size_t f = 0; f < measured.faces.size(); ++f) {
      if (measured.worst[f].distance <= tolerance) continue;
      corners.insert(corners.end(), measured.faces[f].begin(), measured.faces[f].end());
    }
    if (!clusters.undo(corners)) break;
    measured = measure(clusters.faces(), measured, surface, phi);
  }
  Refinement result;
  result.largest_distance = largest_distance(measured.worst);
  result.faces_restored =
      static_cast<std::int64_t>(measured.faces.size()) - static_cast<std::int64_t>(faces_at_first);
  result.faces = std::move(measured.faces);
  return result;
}

}  // namespace cellocut
