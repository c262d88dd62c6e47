// SPDX-License-Identifier: Apache-2.0
#include "image/io/tile_cache.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.h"

namespace chromeball {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

constexpr const char* kImage = "chromeball:image";

// An image of the file, as a reader of OpenImageIO.
class TileInput : public OIIO::ImageInput {
 public:
  const char* format_name() const override { return "tiles"; }
  bool valid_file(const std::string&) const override { return false; }

  bool open(const std::string&, ImageSpec&) override { return false; }
  bool open(const std::string&, ImageSpec& spec, const ImageSpec& config) override {
    if (!config.getattribute(kImage, TypeDesc::PTR, &image_)) return false;
    m_spec = ImageSpec(image_->width, image_->height, 4, image_->type);
    m_spec.tile_width = m_spec.tile_height = image_->tileSide;
    m_spec.tile_depth = 1;
    spec = m_spec;
    return true;
  }
  bool close() override { return true; }

  bool read_native_scanline(int, int, int, int, void*) override { return false; }
  bool read_native_tile(int, int, int x, int y, int, void* texels) override {
    return image_->owner->readTile(*image_, x / image_->tileSide, y / image_->tileSide, texels);
  }

 private:
  const TileCache::Image* image_ = nullptr;
};

OIIO::ImageInput* makeTileInput() { return new TileInput; }

std::string temporaryFolder() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) throwRun("TMPDIR: no folder for a temporary file for textures: {}", error.message());
  return folder;
}

// A file without a name, in `folder`.
int openTemporary(const std::string& folder) {
  std::string name = folder + "/chromeball-texels-XXXXXX";
  const int file = mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) unlink(name.c_str());
  return file;
}

}  // namespace

TileCache::TileCache(size_t bytes) : folder_(temporaryFolder()), cacheBytes_(bytes) {
  file_ = openTemporary(folder_);
  if (file_ < 0)
    throwRun("{}: no temporary file for textures can be created: {}", folder_,
             std::strerror(errno));
  cache_ = OIIO::ImageCache::create(false);
  cache_->attribute("max_memory_MB", float(double(bytes) / (1 << 20)));
  cache_->attribute("max_open_files", 1 << 30);  // our readers share one
}

TileCache::~TileCache() {
  OIIO::ImageCache::destroy(cache_);
  close(file_);
}

void TileCache::append(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(file_, bytes.data(), bytes.size(), off_t(size_));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0)
      throwRun("{}: the temporary file for textures cannot be written: {}", folder_,
               std::strerror(errno));
    size_ += uint64_t(written);
    bytes = bytes.subspan(size_t(written));
  }
}

void TileCache::add(Image image) {
  image.owner = this;
  images_.push_back(image);
  const Image* added = &images_.back();
  ImageSpec config;
  config.attribute(kImage, TypeDesc::PTR, &added);
  const OIIO::ustring name(std::to_string(images_.size()));
  cache_->add_file(name, makeTileInput, &config);
  images_.back().handle = cache_->get_image_handle(name);
}

CachedTile TileCache::get(Reader* reader, int image, int x, int y) {
  if (hasFailed_) return {};
  const Image& from = images_[size_t(image)];
  CachedTile tile;
  tile.handle =
      cache_->get_tile(from.handle, reader, 0, 0, x * from.tileSide, y * from.tileSide, 0);
  if (!tile.handle) {
    fail(cache_->geterror());
    return {};
  }
  TypeDesc type;
  tile.texels = cache_->tile_pixels(tile.handle, type);
  return tile;
}

bool TileCache::readTile(const Image& image, int x, int y, void* texels) {
  const int tilesPerRow = (image.width + image.tileSide - 1) / image.tileSide;
  const uint64_t offset = image.offset + uint64_t(y * tilesPerRow + x) * kTileBytes;
  for (size_t done = 0; done < kTileBytes;) {
    const ssize_t count =
        pread(file_, static_cast<uint8_t*>(texels) + done, kTileBytes - done, off_t(offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      fail(count < 0 ? std::strerror(errno) : "it has become shorter");
      return false;
    }
    done += size_t(count);
  }
  return true;
}

void TileCache::fail(const std::string& reason) {
  const std::lock_guard lock(failing_);
  if (failure_.empty()) failure_ = reason;
  hasFailed_ = true;
}

void TileCache::check() const {
  if (hasFailed_)
    throwRun("{}: the temporary file for textures cannot be read: {}", folder_, failure_);
}

}  // namespace chromeball
