#include "cellocut/measure/nearest_sample.h"

#include <algorithm>
#include <cmath>

#include "cellocut/measure/embree_scene.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct NearestSample::Scene {
  std::vector<Point3> points;
  EmbreeFrame frame;
  EmbreeScene embree;

  explicit Scene(std::vector<Point3> given) : points(std::move(given)) {
    if (points.empty()) return;
    frame = EmbreeFrame(bounding_box(points));
    embree.build(points.size(), this, bounds, visit);
  }

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto* self = static_cast<const Scene*>(arguments->geometryUserPtr);
    const Point3 p = self->frame(self->points[arguments->primID]);
    set_embree_bounds(*arguments->bounds_o, {p, p});
  }

  struct Query {
    const Scene* scene;
    Point3 p;      // in the units of the points
    double slack;  // in the frame
    double squared = std::numeric_limits<double>::infinity();
    std::uint32_t index = kNone;
  };

  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const std::uint32_t index = arguments->primID;
    const double squared = squared_norm(query.scene->points[index] - query.p);
    if (squared > query.squared || (squared == query.squared && index > query.index)) return false;
    query.index = index;
    if (squared == query.squared) return false;
    query.squared = squared;
    const double radius =
        std::sqrt(squared) / query.scene->frame.unit * (1 + kEmbreeRounding) + query.slack;
    arguments->query->radius = std::min(arguments->query->radius, static_cast<float>(radius));
    return true;
  }
};

NearestSample::NearestSample(std::vector<Point3> points)
    : scene_(std::make_unique<Scene>(std::move(points))) {}
NearestSample::~NearestSample() = default;
NearestSample::NearestSample(NearestSample&&) noexcept = default;
NearestSample& NearestSample::operator=(NearestSample&&) noexcept = default;

NearestSample::Result NearestSample::operator()(const Point3& p) const {
  const Point3 q = scene_->frame(p);
  Scene::Query query{.scene = scene_.get(), .p = p, .slack = embree_slack(q)};
  scene_->embree.query(q, std::numeric_limits<float>::infinity(), &query);
  return {query.index, std::sqrt(query.squared)};
}

}  // namespace cellocut
