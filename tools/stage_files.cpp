#include "tools/stage_files.h"

#include <cmath>
#include <filesystem>

#include "cellocut/base/errors.h"
#include "cellocut/mesh/unused_points.h"
#include "cellocut/surface/interface.h"
#include "cellocut/surface/iso_surface.h"
#include "cellocut/validity/face_defects.h"
#include "cellocut_version.h"
#include "tools/labelled_cells.h"
#include "tools/session.h"
#include "viz/vtp_file.h"

namespace cellocut::tools {

namespace {

std::vector<viz::FieldValue> legend(const char* array, const char* text) {
  return {{"cellocut_version", std::string(kCellocutVersion)},
          {std::string("legend_") + array, std::string(text)}};
}

std::string encode_input(const TriangleSoup& input, Observer& observer) {
  FaceDefects defects = find_face_defects(input, observer);
  std::vector<viz::CellArray> faces;
  faces.push_back({"defect", defects.gravest()});
  faces.push_back({"boundary", std::move(defects.boundary)});
  faces.push_back({"nonmanifold", std::move(defects.nonmanifold)});
  faces.push_back({"degenerate", std::move(defects.degenerate)});
  faces.push_back({"intersecting", std::move(defects.intersecting)});
  return viz::encode_vtp(
      input, {},
      legend("defect", "0 none, 1 boundary, 2 non-manifold, 3 degenerate, 4 intersecting"), faces);
}

// The facets that some labelling of interest cuts. (All that are cut are saturated; what the flow
// leaves of the others tells how near they came.)
std::string encode_cut_facets(const RemeshResult& result) {
  const Rational& lambda = result.derived.lambda_fill;
  const auto denominator = static_cast<double>(lambda.denominator);
  const double unit_area = result.frame.unit * result.frame.unit / result.areas.scale;
  TriangleSoup surface;
  surface.points = result.complex.points;
  std::vector<std::uint8_t> cut;
  std::vector<double> area;
  std::vector<double> weight;
  std::vector<double> flow;
  std::vector<double> saturation;
  std::vector<double> supported;
  for (std::size_t f = 0; f < result.facets.size(); ++f) {
    const Facet& facet = result.facets[f];
    const auto differs = [&facet](const CellLabels& labels) {
      const std::uint8_t beyond =
          facet.other == kOutside ? kExterior : labels[static_cast<std::size_t>(facet.other)];
      return labels[facet.cell] != beyond;
    };
    if (!differs(result.initial_label) && !differs(result.smallest_interior) &&
        !differs(result.largest_interior)) {
      continue;
    }
    // Seen from the side that is interior, first of all by the chosen labelling.
    const bool chosen = differs(result.label);
    const CellLabels& labels = chosen ? result.label : result.initial_label;
    Triangle corners = facet_outward(result.complex, facet.cell, facet.corner);
    if (labels[facet.cell] != kInterior) std::swap(corners[1], corners[2]);
    surface.triangles.push_back(corners);
    const auto quanta = static_cast<double>(result.areas.quantised[f]);
    const auto capacity = static_cast<double>(facet_capacity(result.areas, f, lambda));
    const auto carried = std::fabs(static_cast<double>(result.facet_flow[f]));
    cut.push_back(chosen ? 1 : 0);
    area.push_back(quanta * unit_area);
    weight.push_back(capacity / (quanta * denominator));
    flow.push_back(carried / denominator * unit_area);
    saturation.push_back(carried / capacity);
    supported.push_back(static_cast<double>(result.areas.supported[f]) / quanta);
  }
  const std::vector<viz::CellArray> faces{{"saturation", std::move(saturation)},
                                          {"cut", std::move(cut)},
                                          {"area", std::move(area)},
                                          {"weight", std::move(weight)},
                                          {"flow", std::move(flow)},
                                          {"supported", std::move(supported)}};
  return viz::encode_vtp(drop_unused_points(surface.points, surface.triangles), {},
                         legend("cut", "1 between cells of different final label"), faces);
}

// The collection that opens them all.
std::string encode_collection(const std::vector<std::string>& names) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<vtkMultiBlockDataSet>\n";
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string stem = std::filesystem::path(names[i]).stem().string();
    text += "<DataSet index=\"" + std::to_string(i) + "\" name=\"" + stem + "\" file=\"" +
            names[i] + "\"/>\n";
  }
  return text + "</vtkMultiBlockDataSet>\n</VTKFile>\n";
}

}  // namespace

void write_stage_files(const RemeshResult& result, const RemeshOptions& options,
                       const TriangleSoup& input, const std::string& solver,
                       const std::string& folder, Observer& observer) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw OutputError(failure.message(), folder);
  std::vector<std::string> names;
  const auto write = [&](const char* name, const std::string& bytes) {
    write_text((std::filesystem::path(folder) / name).string(), bytes);
    names.emplace_back(name);
  };
  const auto write_surface = [&](const char* name, const TriangleSoup& surface) {
    observer.check();
    if (!surface.empty()) write(name, viz::encode_vtp(surface, {}));
  };
  write("input.vtp", encode_input(input, observer));
  // Extracted again: the pipeline lets go of the full surface when it has the proxy.
  TriangleSoup thickened = extract_iso_surface(result.phi);
  to_input_units(thickened, result.frame);
  write_surface("thickened.vtp", thickened);
  write_surface("proxy.vtp", result.proxy.mesh);
  if (!result.complex.cells.empty()) {
    const TriangleSoup interface =
        interface_triangles(result.complex, list_interface(result.complex, result.initial_label));
    write_surface("interface_initial.vtp",
                  drop_unused_points(interface.points, interface.triangles));
    if (!result.label.empty()) write("cut_facets.vtp", encode_cut_facets(result));
    write("cells.vtu", encode_vtu(labelled_cells(result, options, solver)));
  }
  if (!result.surface.empty()) {
    const std::vector<VertexAttribute> attributes =
        result.provenance.empty() ? std::vector<VertexAttribute>() : result.provenance.attributes();
    write("output.vtp", viz::encode_vtp(result.surface, attributes,
                                        legend("supported", "1 follows the input, 0 completed")));
  }
  write("run.vtm", encode_collection(names));
}

}  // namespace cellocut::tools
