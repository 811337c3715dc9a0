// What clay looks like: the one material and the lights of all pictures.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "cellocut/view/ray_scene.h"

namespace cellocut {

// Linear light, red, green, blue, 0 to 1.
using LinearColour = std::array<double, 3>;

constexpr LinearColour kBackgroundColour{1, 1, 1};

// Directions, spread evenly over the sphere (a Fibonacci lattice), in which it is asked how much of
// the sky a point sees. A pixel's samples share them out: sample k of n takes k, k + n, k + 2 n...
constexpr int kSkyDirections = 64;

// The colour of a hit: a warm grey where the front of a face is seen, red clay where its back is: a
// hole, a sheet or a flipped face shows. A sky that is brighter above, dimmed where faces stand
// within half a unit (ambient occlusion, Zhukov, Iones and Kronin, An ambient light illumination
// model, 1998), a key light from the upper left and a weak one from the right, all of which stand
// still with respect to the camera. Faces are flat. `sample` of `samples`: its share of the sky.
LinearColour clay_colour(const RayScene& scene, const Camera& camera, const Ray& ray,
                         const RayScene::Hit& hit, int sample, int samples);

// The sRGB curve (IEC 61966-2-1), to 8 bits.
std::array<std::uint8_t, 3> to_srgb(const LinearColour& colour);

}  // namespace cellocut
