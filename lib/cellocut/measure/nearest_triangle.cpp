#include "cellocut/measure/nearest_triangle.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "cellocut/base/predicates.h"
#include "cellocut/measure/embree_scene.h"
#include "cellocut/measure/triangle_pieces.h"

namespace cellocut {

namespace {

Point3 nearest_on_segment(const Point3& p, const Point3& a, const Point3& b) {
  const Point3 edge = b - a;
  const double squared = squared_norm(edge);
  const double t = squared > 0 ? std::clamp(dot(p - a, edge) / squared, 0.0, 1.0) : 0.0;
  return a + t * edge;
}

}  // namespace

Point3 nearest_on_triangle(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
  const Point3 normal = cross(b - a, c - a);
  const double squared = squared_norm(normal);
  // Inside the prism over the triangle: the foot of the perpendicular.
  if (squared > 0 && dot(cross(normal, b - a), p - a) >= 0 &&
      dot(cross(normal, c - b), p - b) >= 0 && dot(cross(normal, a - c), p - c) >= 0) {
    return p - (dot(p - a, normal) / squared) * normal;
  }
  Point3 best = nearest_on_segment(p, a, b);
  double least = squared_norm(p - best);
  for (const Point3& q : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)}) {
    const double distance = squared_norm(p - q);
    if (distance < least) {
      least = distance;
      best = q;
    }
  }
  return best;
}

namespace {

// A plane that a triangle of the frame lies in, but for kEmbreeRounding: how far it is at least.
// (Half of the triangles whose boxes a query meets lie in planes that are too far.)
class NearPlane {
 public:
  NearPlane() = default;
  explicit NearPlane(const std::array<Point3, 3>& corners) {
    const Point3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double length = norm(normal);
    if (!(length > 0)) return;
    for (std::size_t k = 0; k < 3; ++k) normal_[k] = static_cast<float>(normal[k] / length);
    height_ = static_cast<float>(height(corners[0]));
    for (const Point3& corner : corners) {
      if (!(std::fabs(height(corner)) <= kEmbreeRounding)) *this = {};  // as of slivers
    }
  }
  [[nodiscard]] bool beyond(const Point3& p, float radius) const {
    return std::fabs(height(p)) > static_cast<double>(radius) + kEmbreeRounding;
  }

 private:
  [[nodiscard]] double height(const Point3& p) const {
    return (static_cast<double>(normal_[0]) * p[0] + static_cast<double>(normal_[1]) * p[1] +
            static_cast<double>(normal_[2]) * p[2]) -
           static_cast<double>(height_);
  }

  std::array<float, 3> normal_{};  // 0: no such plane, and nothing is beyond it
  float height_ = 0;               // of the triangle
};

}  // namespace

// Corners are in the coordinates of the frame.
struct NearestTriangle::Scene {
  std::vector<std::array<Point3, 3>> corners;
  std::vector<NearPlane> planes;    // of corners[i]
  std::vector<std::uint32_t> face;  // corners[i] are those of this face of the soup
  // Primitives of the hierarchy: the triangles but for the long ones, then the pieces of these.
  std::vector<TrianglePiece> pieces;
  std::vector<bool> in_pieces;  // by triangle
  EmbreeFrame frame;
  EmbreeScene embree;

  explicit Scene(const TriangleSoup& soup);

  // The order of the corners and of the triangles is that of their coordinates: what is nearest, to
  // the last bit, does not depend on the order in the file.
  void sort_triangles() {
    std::vector<std::uint32_t> order(face.size());
    std::iota(order.begin(), order.end(), 0U);
    tbb::parallel_sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
      return corners[a] != corners[b] ? corners[a] < corners[b] : a < b;
    });
    std::vector<std::array<Point3, 3>> sorted_corners(order.size());
    std::vector<std::uint32_t> sorted_face(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      sorted_corners[i] = corners[order[i]];
      sorted_face[i] = face[order[i]];
    }
    corners = std::move(sorted_corners);
    face = std::move(sorted_face);
  }

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto* self = static_cast<const Scene*>(arguments->geometryUserPtr);
    const std::uint32_t primitive = arguments->primID;
    const std::size_t triangles = self->corners.size();
    const bool whole = primitive < triangles;
    const std::array<Point3, 3>& t =
        whole ? self->corners[primitive] : self->pieces[primitive - triangles].corners;
    Box3 box{t[0], t[0]};
    box.include(t[1]);
    box.include(t[2]);
    if (whole && self->in_pieces[primitive]) std::swap(box.low, box.high);  // leaves it out
    set_embree_bounds(*arguments->bounds_o, box);
  }

  // Sees each triangle, some of them more than once, that may lie within `radius`; may lower that,
  // and then returns true.
  class Search {
   public:
    virtual bool visit(std::uint32_t triangle, float& radius) = 0;

   protected:
    ~Search() = default;
  };

  [[nodiscard]] std::uint32_t triangle_of(std::uint32_t primitive) const {
    return primitive < corners.size() ? primitive : pieces[primitive - corners.size()].triangle;
  }

  void run(Search& search, const Point3& p, float radius) const {
    Query query{*this, search};
    embree.query(p, radius, &query);
  }

  struct Query {
    const Scene& scene;
    Search& search;
  };
  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    const auto* query = static_cast<const Query*>(arguments->userPtr);
    return query->search.visit(query->scene.triangle_of(arguments->primID),
                               arguments->query->radius);
  }
};

namespace {

// All in the frame.
template <class Scene>
class Nearest final : public Scene::Search {
 public:
  Nearest(const Scene& scene, const Point3& p, double limit)
      : scene_(scene), p_(p), slack_(embree_slack(p)), squared(limit * limit) {}

  [[nodiscard]] float radius() const {
    return static_cast<float>(std::sqrt(squared) * (1 + kEmbreeRounding) + slack_);
  }

  bool visit(std::uint32_t candidate, float& radius) override {
    if (scene_.planes[candidate].beyond(p_, radius)) return false;
    const std::array<Point3, 3>& t = scene_.corners[candidate];
    const Point3 nearest = nearest_on_triangle(p_, t[0], t[1], t[2]);
    const double candidate_squared = squared_norm(p_ - nearest);
    const bool nearer = candidate_squared < squared;
    if (!nearer && !(candidate_squared == squared && candidate < primitive)) return false;
    squared = candidate_squared;
    primitive = candidate;
    point = nearest;
    if (!nearer) return false;
    radius = std::min(radius, this->radius());
    return true;
  }

 private:
  const Scene& scene_;
  Point3 p_;
  double slack_;

 public:
  double squared;
  std::uint32_t primitive = NearestPoint::kNone;
  Point3 point{};
};

template <class Scene>
class Separation final : public Scene::Search {
 public:
  Separation(const Scene& scene, const Point3& p, const Point3& q) : scene_(scene), p_(p), q_(q) {}

  bool visit(std::uint32_t candidate, float& radius) override {
    if (found) return false;
    const auto& [a, b, c] = scene_.corners[candidate];
    if (orientation(a, b, c, p_) * orientation(a, b, c, q_) > 0) return false;
    // The line through p and q passes all edges on the same side, or touches some.
    const int ab = orientation(p_, q_, a, b);
    const int bc = orientation(p_, q_, b, c);
    const int ca = orientation(p_, q_, c, a);
    found = std::max({ab, bc, ca}) <= 0 || std::min({ab, bc, ca}) >= 0;
    if (found) radius = 0;
    return found;
  }

  bool found = false;

 private:
  const Scene& scene_;
  Point3 p_;
  Point3 q_;
};

}  // namespace

NearestTriangle::Scene::Scene(const TriangleSoup& soup) {
  for (std::uint32_t f = 0; f < soup.triangles.size(); ++f) {
    const Triangle& t = soup.triangles[f];
    if (!is_finite(soup.points[t[0]]) || !is_finite(soup.points[t[1]]) ||
        !is_finite(soup.points[t[2]])) {
      continue;
    }
    corners.push_back({soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]});
    std::sort(corners.back().begin(), corners.back().end());
    face.push_back(f);
  }
  if (corners.empty()) return;
  sort_triangles();
  Box3 box{corners[0][0], corners[0][0]};
  for (const std::array<Point3, 3>& t : corners) {
    for (const Point3& p : t) box.include(p);
  }
  frame = EmbreeFrame(box);
  planes.resize(corners.size());
  tbb::parallel_for(std::size_t{0}, corners.size(), [&](std::size_t i) {
    for (Point3& p : corners[i]) p = frame(p);
    planes[i] = NearPlane(corners[i]);
  });
  // No edge longer than an eighth of the box. (Pieces that are smaller still, or more, save no more
  // than they cost, see docs/performance.md.)
  pieces = cut_long_triangles(corners, 0.125, 1U << 14U);
  in_pieces.assign(corners.size(), false);
  for (const TrianglePiece& piece : pieces) in_pieces[piece.triangle] = true;
  embree.build(corners.size() + pieces.size(), this, bounds, visit);
}

NearestTriangle::NearestTriangle(const TriangleSoup& soup)
    : scene_(std::make_unique<Scene>(soup)) {}
NearestTriangle::~NearestTriangle() = default;
NearestTriangle::NearestTriangle(NearestTriangle&&) noexcept = default;
NearestTriangle& NearestTriangle::operator=(NearestTriangle&&) noexcept = default;

NearestPoint NearestTriangle::operator()(const Point3& p, double limit) const {
  const Scene& s = *scene_;
  NearestPoint result;
  if (!is_finite(p)) return result;
  const Point3 q = s.frame(p);
  Nearest<Scene> search(s, q, limit / s.frame.unit);
  s.run(search, q, search.radius());
  if (search.primitive == NearestPoint::kNone) return result;
  result.face = s.face[search.primitive];
  result.point = s.frame.centre + s.frame.unit * search.point;
  result.distance = std::sqrt(search.squared) * s.frame.unit;
  return result;
}

bool NearestTriangle::may_separate(const Point3& p, const Point3& q) const {
  const Scene& s = *scene_;
  const Point3 from = s.frame(p);
  const Point3 to = s.frame(q);
  const Point3 middle = 0.5 * (from + to);
  const double half = 0.5 * std::sqrt(squared_norm(to - from));
  Separation<Scene> search(s, from, to);
  s.run(search, middle, static_cast<float>(half * (1 + kEmbreeRounding) + embree_slack(middle)));
  return search.found;
}

}  // namespace cellocut
