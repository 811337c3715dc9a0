#include "cellocut/image/image_evaluation.h"

#include "cellocut/image/ms_ssim.h"
#include "cellocut/image/view_agreement.h"

namespace cellocut {

namespace {

ViewFeatures features_of(const std::vector<View>& views, const ImageNetwork* network,
                         const Observer& observer) {
  ViewFeatures features;
  if (network == nullptr) return features;
  features.reserve(views.size());
  for (const View& view : views) {
    observer.check();
    features.push_back(network->embedding(view));
  }
  return features;
}

void measure_with_networks(const View& view, const View& reference, const ImageNetworks& networks,
                           const Observer& observer, ImageMeasures& result) {
  observer.check();
  if (networks.lpips) {
    result.lpips = lpips_distance((*networks.lpips)(view), (*networks.lpips)(reference),
                                  networks.lpips_weights);
  }
  observer.check();
  if (networks.clip) {
    result.clip = cosine_score(networks.clip->embedding(view), networks.clip->embedding(reference));
  }
}

std::optional<double> mean_of(const std::vector<ImageMeasures>& views,
                              std::optional<double> ImageMeasures::*measure) {
  double sum = 0;
  int count = 0;
  for (const ImageMeasures& view : views) {
    if (!(view.*measure)) continue;
    sum += *(view.*measure);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

}  // namespace

ImageEvaluator::ImageEvaluator(const TriangleSoup& reference, const RenderOptions& options,
                               std::shared_ptr<const ImageNetworks> networks,
                               const Observer& observer)
    : options_(options),
      networks_(std::move(networks)),
      frame_(view_frame(reference)),
      views_(render_views(reference, frame_, options, observer)),
      features_(features_of(views_, networks_->fid.get(), observer)) {}

ImageAgreement ImageEvaluator::operator()(const TriangleSoup& mesh,
                                          const Observer& observer) const {
  const std::vector<View> views = render_views(mesh, frame_, options_, observer);
  ImageAgreement result;
  result.views.reserve(views.size());
  for (std::size_t k = 0; k < views.size(); ++k) {
    ImageMeasures found;
    found.silhouette_iou = silhouette_iou(views[k], views_[k]);
    found.depth_error = depth_error(views[k], views_[k]);
    found.normal_error = normal_error(views[k], views_[k]);
    const MsSsim similarity = ms_ssim(grey_image(views[k]), grey_image(views_[k]));
    found.ms_ssim = similarity.value;
    result.ms_ssim_scales = similarity.scales;
    measure_with_networks(views[k], views_[k], *networks_, observer, found);
    result.views.push_back(found);
    result.names.push_back(views[k].name);
  }
  for (const auto measure :
       {&ImageMeasures::silhouette_iou, &ImageMeasures::depth_error, &ImageMeasures::normal_error,
        &ImageMeasures::ms_ssim, &ImageMeasures::lpips, &ImageMeasures::clip}) {
    result.mean.*measure = mean_of(result.views, measure);
  }
  result.features = features_of(views, networks_->fid.get(), observer);
  result.reference_features = features_;
  return result;
}

}  // namespace cellocut
