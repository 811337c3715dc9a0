// How alike two meshes look: the measures of pictures, over six canonical views.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/image/network.h"
#include "cellocut/view/render.h"

namespace cellocut {

// Networks that measure; an empty pointer leaves its measure out.
struct ImageNetworks {
  std::shared_ptr<const ImageNetwork> lpips;
  std::vector<std::vector<double>> lpips_weights{};  // of each output, of each channel
  std::shared_ptr<const ImageNetwork> fid;
  std::shared_ptr<const ImageNetwork> clip;
};

// What is absent could not be measured: nothing is seen, the picture is too small, no network.
struct ImageMeasures {
  std::optional<double> silhouette_iou;  // 0 to 1
  std::optional<double> depth_error;     // in longest edges of the reference
  std::optional<double> normal_error;    // degrees
  std::optional<double> ms_ssim;         // 0 to 1
  std::optional<double> lpips;
  std::optional<double> clip;  // -100 to 100
  bool operator==(const ImageMeasures&) const = default;
};

// The feature vectors of FID, one for each view; empty without its network.
using ViewFeatures = std::vector<std::vector<float>>;

struct ImageAgreement {
  ImageMeasures mean;  // of each measure, over the views that have it
  std::vector<ImageMeasures> views;
  std::vector<std::string> names;  // of the views
  int ms_ssim_scales = 0;          // 5, unless the pictures are small
  ViewFeatures features;           // of the mesh
  ViewFeatures reference_features;
};

// Holds the views of a reference, for any number of meshes.
class ImageEvaluator {
 public:
  // Errors: UsageError by options.validate(); InputError where the reference has no extent, or as
  // ImageNetwork; Cancelled. Parallel.
  ImageEvaluator(const TriangleSoup& reference, const RenderOptions& options,
                 std::shared_ptr<const ImageNetworks> networks,
                 const Observer& observer = silent_observer());

  // The mesh is seen by the camera that took the reference. The same bits for any number of
  // threads. Errors: as RayScene and ImageNetwork; InputError where weights do not fit the network;
  // Cancelled. Parallel.
  [[nodiscard]] ImageAgreement operator()(const TriangleSoup& mesh,
                                          const Observer& observer = silent_observer()) const;

 private:
  RenderOptions options_;
  std::shared_ptr<const ImageNetworks> networks_;
  ViewFrame frame_;
  std::vector<View> views_;
  ViewFeatures features_;
};

}  // namespace cellocut
