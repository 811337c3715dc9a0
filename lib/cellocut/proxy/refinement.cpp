#include "cellocut/proxy/refinement.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "cellocut/base/raster_points.h"
#include "cellocut/proxy/departure.h"
#include "cellocut/proxy/nearest_vertex.h"

namespace cellocut {

namespace {

constexpr double kRaster = 0.5;  // grid steps between the points that find faces around
constexpr int kMostRounds = 4;   // nearly all is done in the first two

std::array<Point3, 3> corners_of(const std::vector<Point3>& points, const Triangle& face) {
  return {points[face[0]], points[face[1]], points[face[2]]};
}

// Faces and how far each departs.
struct Measured {
  std::vector<Triangle> faces;
  std::vector<Departure> worst;

  void add(const Triangle& face, const Departure& departure) {
    faces.push_back(face);
    worst.push_back(departure);
  }

  void measure(const std::vector<Point3>& points, const std::vector<Triangle>& more,
               const SparseField& phi) {
    const std::vector<Departure> departures = measure_faces(points, more, phi);
    faces.insert(faces.end(), more.begin(), more.end());
    worst.insert(worst.end(), departures.begin(), departures.end());
  }

  [[nodiscard]] double largest() const { return largest_distance(worst); }
};

// The vertices at which edges are split. An edge is named by its corners, the lower first, so that
// all of its faces split it alike.
class EdgeSplits {
 public:
  // Judges the edge once; whether it is to be split.
  template <class Judge>
  bool judge(std::uint32_t a, std::uint32_t b, const Judge& judge) {
    const auto [entry, fresh] = split_.try_emplace(key(a, b), NearestVertex::kNone);
    if (fresh) entry->second = judge(std::min(a, b), std::max(a, b));
    return entry->second != NearestVertex::kNone;
  }
  [[nodiscard]] std::uint32_t at(std::uint32_t a, std::uint32_t b) const {
    const auto found = split_.find(key(a, b));
    return found == split_.end() ? NearestVertex::kNone : found->second;
  }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
  }
  std::unordered_map<std::uint64_t, std::uint32_t> split_;
};

void add_face(std::vector<Triangle>& faces, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a != b && b != c && c != a) faces.push_back({a, b, c});
}

// Splits the face at those of its edges that are to be split; whether there was one.
bool split_at_edges(const std::vector<Point3>& points, const Triangle& face,
                    const EdgeSplits& edges, std::vector<Triangle>& parts) {
  std::array<std::uint32_t, 3> middle{};  // of the edge from corner k to the next
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    middle[k] = edges.at(face[k], face[(k + 1) % 3]);
    count += middle[k] != NearestVertex::kNone ? 1 : 0;
  }
  if (count == 0) return false;
  if (count == 3) {
    for (int k = 0; k < 3; ++k) add_face(parts, face[k], middle[k], middle[(k + 2) % 3]);
    add_face(parts, middle[0], middle[1], middle[2]);
    return true;
  }
  // Turned so that the first edge is split and, of two, the second is the other.
  int first = 0;
  while (middle[first] == NearestVertex::kNone ||
         (count == 2 && middle[(first + 1) % 3] == NearestVertex::kNone)) {
    ++first;
  }
  const std::uint32_t a = face[first];
  const std::uint32_t b = face[(first + 1) % 3];
  const std::uint32_t c = face[(first + 2) % 3];
  const std::uint32_t ab = middle[first];
  if (count == 1) {
    add_face(parts, a, ab, c);
    add_face(parts, ab, b, c);
    return true;
  }
  const std::uint32_t bc = middle[(first + 1) % 3];
  add_face(parts, ab, b, bc);
  // The shorter diagonal of what is left.
  if (squared_norm(points[a] - points[bc]) <= squared_norm(points[ab] - points[c])) {
    add_face(parts, a, ab, bc);
    add_face(parts, a, bc, c);
  } else {
    add_face(parts, a, ab, c);
    add_face(parts, ab, bc, c);
  }
  return true;
}

// Where one round splits faces that are too far away, and the faces that share an edge with them.
class Splits {
 public:
  Splits(const std::vector<Point3>& points, const NearestVertex& nearest, const SparseField& phi,
         double tolerance)
      : points_(points), nearest_(nearest), phi_(phi), tolerance_(tolerance) {}

  // Decides where to split a face that is too far away; nowhere if no vertex is near.
  void add(const Triangle& face, const Departure& worst) {
    bool at_edge = false;
    for (int k = 0; k < 3; ++k) {
      at_edge |= edges_.judge(face[k], face[(k + 1) % 3],
                              [&](std::uint32_t a, std::uint32_t b) { return judge_edge(a, b); });
    }
    if (at_edge) return;
    const std::uint32_t vertex = nearest_(worst.at, face);
    if (vertex != NearestVertex::kNone) inside_.emplace(face, vertex);
  }

  // The parts of a face; whether it has to be split.
  bool split(const Triangle& face, std::vector<Triangle>& parts) const {
    if (split_at_edges(points_, face, edges_, parts)) return true;
    const auto found = inside_.find(face);
    if (found == inside_.end()) return false;
    for (int k = 0; k < 3; ++k) add_face(parts, face[k], face[(k + 1) % 3], found->second);
    return true;
  }

 private:
  std::uint32_t judge_edge(std::uint32_t a, std::uint32_t b) {
    const Departure worst = measure_edge(points_[a], points_[b], phi_);
    if (worst.distance <= tolerance_) return NearestVertex::kNone;
    return nearest_(worst.at, std::array<std::uint32_t, 2>{a, b});
  }

  const std::vector<Point3>& points_;
  const NearestVertex& nearest_;
  const SparseField& phi_;
  double tolerance_;
  EdgeSplits edges_;
  std::map<Triangle, std::uint32_t> inside_;
};

// The faces of `surface` around those given: with a corner in a grid cell that touches one.
std::vector<Triangle> faces_around(const TriangleSoup& surface, const std::vector<Triangle>& gone) {
  const auto key = [](const Point3& p, int dx, int dy, int dz) {
    const auto part = [](double x, int d) {
      return static_cast<std::uint64_t>(static_cast<int>(x) + d + 8) & 0x1FFFFF;
    };
    return (part(p[0], dx) << 42) | (part(p[1], dy) << 21) | part(p[2], dz);
  };
  std::unordered_set<std::uint64_t> cells;
  std::uint64_t last = ~std::uint64_t{0};  // no cell's
  for (const Triangle& t : gone) {
    for_each_raster_point(corners_of(surface.points, t), kRaster, [&](const Point3& p) {
      if (key(p, 0, 0, 0) == last) return;
      last = key(p, 0, 0, 0);
      for (int n = 0; n < 27; ++n) cells.insert(key(p, n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1));
    });
  }
  constexpr std::size_t kChunks = 64;
  std::array<std::vector<Triangle>, kChunks> found;
  tbb::parallel_for(std::size_t{0}, kChunks, [&](std::size_t chunk) {
    const std::size_t count = surface.triangles.size();
    for (std::size_t f = chunk * count / kChunks; f < (chunk + 1) * count / kChunks; ++f) {
      const Triangle& t = surface.triangles[f];
      if (cells.count(key(surface.points[t[0]], 0, 0, 0)) != 0) found[chunk].push_back(t);
    }
  });
  std::vector<Triangle> around;
  for (const auto& faces : found) around.insert(around.end(), faces.begin(), faces.end());
  return around;
}

Measured split_once(const std::vector<Point3>& points, const Measured& before,
                    const NearestVertex& nearest, const SparseField& phi, double tolerance) {
  Splits splits(points, nearest, phi, tolerance);
  for (std::size_t f = 0; f < before.faces.size(); ++f) {
    if (before.worst[f].distance > tolerance) splits.add(before.faces[f], before.worst[f]);
  }
  Measured after;
  std::vector<Triangle> parts;
  for (std::size_t f = 0; f < before.faces.size(); ++f) {
    if (!splits.split(before.faces[f], parts)) after.add(before.faces[f], before.worst[f]);
  }
  after.measure(points, parts, phi);
  return after;
}

// Faces that are still too far away give way to those of the full surface; how many came.
std::int64_t restore(const TriangleSoup& surface, Measured& measured, const SparseField& phi,
                     double tolerance) {
  Measured close;
  std::vector<Triangle> gone;
  for (std::size_t f = 0; f < measured.faces.size(); ++f) {
    if (measured.worst[f].distance > tolerance) {
      gone.push_back(measured.faces[f]);
    } else {
      close.add(measured.faces[f], measured.worst[f]);
    }
  }
  if (gone.empty()) return 0;
  const std::vector<Triangle> restored = faces_around(surface, gone);
  close.measure(surface.points, restored, phi);
  measured = std::move(close);
  return static_cast<std::int64_t>(restored.size());
}

}  // namespace

Refinement refine_to_surface(const TriangleSoup& surface, const std::vector<Triangle>& faces,
                             const SparseField& phi, double tolerance, Observer& observer) {
  const std::vector<Point3>& points = surface.points;
  Measured measured;
  measured.measure(points, faces, phi);
  Refinement result;
  if (measured.largest() > tolerance) {
    const NearestVertex nearest(points);
    for (int round = 0; round < kMostRounds && measured.largest() > tolerance; ++round) {
      observer.check();
      measured = split_once(points, measured, nearest, phi, tolerance);
    }
    result.faces_restored = restore(surface, measured, phi, tolerance);
  }
  result.largest_distance = measured.largest();
  result.faces = std::move(measured.faces);
  return result;
}

}  // namespace cellocut
