// The simplified proxy S_sim: the surface phi = 0 with most of its faces removed. Its vertices
// become the points of the Delaunay complex.
#pragma once

#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/field/frame.h"
#include "cellocut/field/sparse_field.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// How far the proxy may depart from phi = 0, in grid steps.
inline constexpr double kProxyTolerance = 0.5;

// How far a vertex is moved per axis, in grid steps: little against the grid, much against
// rounding.
inline constexpr double kTieBreak = 0x1p-13;

enum class DecimationMethod {
  clusters,  // of vertices, in a hierarchy (clustering.h)
  quadric    // edge collapses (edge_collapses.h), about half as fast: a reference
};

struct Decimation {
  double removed_share = 0.95;  // of the faces, 0 to 0.99
  DecimationMethod method = DecimationMethod::clusters;
};

struct Proxy {
  // In input units, rounded once to the doubles that files will hold. Need not be manifold.
  TriangleSoup mesh;
  std::int64_t faces_before = 0;
  double removed_share = 0;         // 1 - faces / faces_before, as reached
  double largest_distance = 0;      // measured max of |phi| over the proxy, in grid steps
  std::int64_t faces_restored = 0;  // came back where nothing less was close enough
};

// Decimates `surface` (phi = 0 in index coordinates, from extract_iso_surface) until
// the share asked of its faces is gone, and splits faces that went further from phi = 0 than
// kProxyTolerance: the distance wins over the share, and only where it has to.
//
// Every vertex is moved first, by up to kTieBreak and by a rule that depends on its place alone.
// The vertices of flat surfaces lie in rows and layers, any number of them on one sphere, and
// rounding would decide what Delaunay makes of them: another one for another scale of the input and
// for another backend. Moved they hardly ever do.
//
// Precondition: removed_share in [0, 0.99]. Errors: Cancelled.
Proxy make_proxy(TriangleSoup surface, const SparseField& phi, const Frame& frame,
                 const Decimation& decimation, Observer& observer);

}  // namespace cellocut
