#include "cellocut/image/png_file.h"

#include <png.h>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

// libpng's simplified interface: errors are returned, not jumped out of.
std::string encode(const void* pixels, int width, int height, png_uint_32 format) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, 0, nullptr) == 0) {
    throw LimitError(std::string("a picture cannot be encoded: ") + image.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::string encode_png(const std::vector<std::array<std::uint8_t, 3>>& pixels, int width,
                       int height) {
  return encode(pixels.data(), width, height, PNG_FORMAT_RGB);
}

std::string encode_png(const std::vector<std::uint16_t>& levels, int width, int height) {
  return encode(levels.data(), width, height, PNG_FORMAT_LINEAR_Y);
}

}  // namespace cellocut
