// What the page of a comparison shows of its meshes, gathered as they are compared.
#pragma once

#include <string>

#include "cellocut/pipeline.h"
#include "tools/html_report.h"
#ifdef CELLOCUT_WITH_VIZ
#include "viz/vtu_file.h"
#endif

namespace cellocut::tools {

class ComparisonPage {
 public:
  // The number of meshes to come: the faces of the 3D view are shared out among them.
  explicit ComparisonPage(std::size_t meshes);

  // The input and the boundary of the interior cells (where there is a labelling), decimated. After
  // ten meshes the page says what is left out, as more would leave each too few faces.
  void add_scene(const std::string& name, const std::string& backend, const RemeshResult& result,
                 const TriangleSoup& input);

#ifdef CELLOCUT_WITH_VIZ
  // The labelled cells with the outline of the input, half way along y, as a drawing or, where that
  // takes too many bytes, as pixels. Nothing where the cells have no array "label".
  void add_section(std::size_t instance, const viz::LabelledCells& cells, const TriangleSoup& input,
                   const std::string& name);
#endif

  PageContent take();

 private:
  std::size_t meshes_;
  PageContent content_;
};

}  // namespace cellocut::tools
