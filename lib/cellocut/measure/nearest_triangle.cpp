#include "cellocut/measure/nearest_triangle.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "cellocut/measure/embree_scene.h"

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

// Corners are in the coordinates of the frame.
struct NearestTriangle::Scene {
  std::vector<std::array<Point3, 3>> corners;
  std::vector<std::uint32_t> face;  // corners[i] are those of this face of the soup
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
    const std::array<Point3, 3>& t = self->corners[arguments->primID];
    Box3 box;
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min({t[0][axis], t[1][axis], t[2][axis]});
      box.high[axis] = std::max({t[0][axis], t[1][axis], t[2][axis]});
    }
    set_embree_bounds(*arguments->bounds_o, box);
  }

  struct Query {
    const Scene* scene;
    Point3 p;  // in the frame
    double slack;
    double squared = std::numeric_limits<double>::infinity();
    std::uint32_t primitive = NearestPoint::kNone;
    Point3 point{};

    [[nodiscard]] float radius() const {
      return static_cast<float>(std::sqrt(squared) * (1 + kEmbreeRounding) + slack);
    }
  };

  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const std::uint32_t primitive = arguments->primID;
    const std::array<Point3, 3>& t = query.scene->corners[primitive];
    const Point3 point = nearest_on_triangle(query.p, t[0], t[1], t[2]);
    const double squared = squared_norm(query.p - point);
    const bool nearer = squared < query.squared;
    if (!nearer && !(squared == query.squared && primitive < query.primitive)) return false;
    query.squared = squared;
    query.primitive = primitive;
    query.point = point;
    if (!nearer) return false;
    arguments->query->radius = std::min(arguments->query->radius, query.radius());
    return true;
  }
};

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
  for (std::array<Point3, 3>& t : corners) {
    for (Point3& p : t) p = frame(p);
  }
  embree.build(corners.size(), this, bounds, visit);
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
  Scene::Query query{.scene = &s, .p = q, .slack = embree_slack(q)};
  const double scaled_limit = limit / s.frame.unit;
  query.squared = scaled_limit * scaled_limit;
  s.embree.query(q, query.radius(), &query);
  if (query.primitive == NearestPoint::kNone) return result;
  result.face = s.face[query.primitive];
  result.point = s.frame.centre + s.frame.unit * query.point;
  result.distance = std::sqrt(query.squared) * s.frame.unit;
  return result;
}

}  // namespace cellocut
