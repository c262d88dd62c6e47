// SPDX-License-Identifier: Apache-2.0
// libchromeball_imageio.so: files that OpenImageIO reads.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "image/imageio/strip_tiff.h"
#include "image/io/imageio_module.h"

namespace chromeball {
namespace {

class OpenedImage : public ModuleImage {
 public:
  OpenedImage(const char* format, std::span<const uint8_t> file, const char* name)
      : file_(stripTiff(file)), memory_(file_.data(), file_.size()) {
    open(format, name);
    const OIIO::ImageSpec& spec = input_->spec();
    if (spec.deep || spec.depth > 1)
      throw std::runtime_error("deep and volume images are not supported");
    header_ = {.width = spec.width,
               .height = spec.height,
               .channels = channelNames(spec),
               .integerBits = spec.format.is_floating_point() ? 0 : int(8 * spec.format.basesize()),
               .alphaChannel = spec.alpha_channel,
               .unassociatedAlpha =
                   spec.alpha_channel >= 0 && spec.get_int_attribute("oiio:UnassociatedAlpha") != 0,
               .bytes = spec.image_bytes(true)};
    // The library's decoder of JPEG multiplies by alpha, before sRGB is decoded.
    if (header_.unassociatedAlpha && spec.get_string_attribute("compression") == "jpeg")
      throw std::runtime_error(
          "its alpha is unassociated and its compression JPEG, which is not supported; save it "
          "with another compression");
  }

  const ModuleImageHeader& header() const override { return header_; }

  void read(float* texels) override {
    const OIIO::ImageSpec spec = input_->spec();
    if (holdsContiguousDoubles(spec)) return readDoubles(spec, texels);
    const bool wasRead =
        spec.tile_width ? input_->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, texels)
                        : readRows(spec, texels);
    if (!wasRead || input_->has_error()) throw std::runtime_error(reasonOf(input_->geterror()));
    if (isWhiteZero(spec) && header_.integerBits > 0) turnGrey(spec, texels);
  }

 private:
  // libtiff goes to a row of each channel in turn, and not back within a compressed strip.
  static std::string reasonOf(const std::string& error) {
    if (error.find("random access") == std::string::npos) return error;
    return "its channels are stored one after the other, in compressed strips of several rows, "
           "which is not supported; save it with interleaved channels";
  }

  static bool holdsContiguousDoubles(const OIIO::ImageSpec& spec) {
    return spec.format == OIIO::TypeDesc::DOUBLE &&
           (spec.nchannels == 1 || spec.get_string_attribute("planarconfig") != "separate");
  }

  // The library inflates whole strips by itself: it returns damaged ones as they are, and cuts
  // strips that are longer than zlib would make them. So rows are read, by libtiff.
  bool readRows(const OIIO::ImageSpec& spec, float* texels) {
    const size_t rowLength = size_t(spec.width) * size_t(spec.nchannels);
    for (int y = 0; y < spec.height; ++y)
      if (!input_->read_scanlines(0, 0, spec.y + y, spec.y + y + 1, spec.z, 0, spec.nchannels,
                                  OIIO::TypeDesc::FLOAT, texels + size_t(y) * rowLength))
        return false;
    return true;
  }

  // `spec`: describes the doubles. A row of texels is one block, unless there are tiles.
  void readDoubles(const OIIO::ImageSpec& spec, float* texels) {
    BytesOfDoubles image = bytesOfDoubles(file_);
    input_.reset();
    file_.swap(image.file);
    memory_ = OIIO::Filesystem::IOMemReader(file_.data(), file_.size());
    open("tiff", "doubles.tif");
    const OIIO::ImageSpec& bytes = input_->spec();
    const bool isTiled = spec.tile_width != 0;
    const int blockWidth = isTiled ? spec.tile_width : spec.width,
              blockHeight = isTiled ? spec.tile_height : 1, scale = int(sizeof(double));
    const size_t samples = size_t(spec.nchannels);
    if (bytes.width != scale * spec.width || bytes.nchannels != spec.nchannels ||
        bytes.format != OIIO::TypeDesc::UINT8 || bytes.tile_width != scale * spec.tile_width)
      throw std::runtime_error("its numbers of 64 bits cannot be read");
    const size_t rowBytes = size_t(blockWidth) * samples * sizeof(double);
    std::vector<uint8_t> block(rowBytes * size_t(blockHeight));
    std::vector<double> numbers;
    for (int top = 0; top < spec.height; top += blockHeight)
      for (int left = 0; left < spec.width; left += blockWidth) {
        const int x = bytes.x + scale * left, y = bytes.y + top;
        const bool wasRead =
            isTiled ? input_->read_tile(x, y, bytes.z, OIIO::TypeDesc::UINT8, block.data())
                    : input_->read_scanlines(0, 0, y, y + 1, bytes.z, 0, bytes.nchannels,
                                             OIIO::TypeDesc::UINT8, block.data());
        if (!wasRead || input_->has_error()) throw std::runtime_error(input_->geterror());
        for (int row = 0; row < std::min(blockHeight, spec.height - top); ++row) {
          decodeDoubles(image, std::span(block).subspan(size_t(row) * rowBytes, rowBytes), samples,
                        numbers);
          float* to = texels + (size_t(top + row) * size_t(spec.width) + size_t(left)) * samples;
          const size_t count = size_t(std::min(blockWidth, spec.width - left)) * samples;
          for (size_t i = 0; i < count; ++i) to[i] = float(numbers[i]);
        }
      }
  }

  // Inverts grey, but not alpha, where 0 is white. The library has inverted all channels of 8 bits,
  // and no others.
  void turnGrey(const OIIO::ImageSpec& spec, float* texels) const {
    const size_t channels = size_t(spec.nchannels);
    const bool isTurned = header_.integerBits == 8;
    for (size_t i = 0; i < spec.image_pixels() * channels; ++i)
      if ((i % channels == 0) != isTurned) texels[i] = 1 - texels[i];
  }

  // For grey images the library names further samples after colours, although the file does not.
  // Three samples without alpha are colour whose writer states grey, as some do for floats.
  static std::vector<std::string> channelNames(const OIIO::ImageSpec& spec) {
    std::vector<std::string> names = spec.channelnames;
    const int photometric = spec.get_int_attribute("tiff:PhotometricInterpretation", -1);
    if (photometric < 0 || photometric > 1 || (spec.nchannels == 3 && spec.alpha_channel < 0))
      return names;
    for (int c = 0; c < spec.nchannels; ++c)
      names[size_t(c)] = c == 0                    ? "Y"
                         : c == spec.alpha_channel ? "A"
                                                   : "channel" + std::to_string(c);
    return names;
  }

  // TIFF 6.0, PhotometricInterpretation: 0 is white.
  static bool isWhiteZero(const OIIO::ImageSpec& spec) {
    return spec.get_int_attribute("tiff:PhotometricInterpretation", -1) == 0;
  }

  // The reader is given by name, because OpenImageIO passes a file that one reader rejects to all
  // others in turn, among them readers of film, camera and medical formats; one of these allocates
  // 2 GB for a file of 400 bytes. The mutex is needed because version 2.4 looks up ICC and EXIF
  // tags in tables that the look-up itself extends without a lock (OpenImageIO's issue 3756).
  void open(const char* format, const char* name) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    input_ = OIIO::ImageInput::create(format);
    if (!input_) throw std::runtime_error(OIIO::geterror());
    OIIO::Filesystem::IOProxy* proxy = &memory_;
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    // Our reader associates alpha; the library would do so before the texels are decoded.
    config.attribute("oiio:UnassociatedAlpha", 1);
    if (!input_->open(name, spec, config)) throw std::runtime_error(input_->geterror());
  }

  std::vector<uint8_t> file_;
  OIIO::Filesystem::IOMemReader memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
  ModuleImageHeader header_;
};

}  // namespace
}  // namespace chromeball

extern "C" [[gnu::visibility("default")]] const char* chromeballImageioVersion() {
  return CHROMEBALL_VERSION;
}

extern "C" [[gnu::visibility("default")]] const char* chromeballImageioLibrary() {
  static const std::string version = OIIO::get_string_attribute("version");
  return version.c_str();
}

extern "C" [[gnu::visibility("default")]] chromeball::ModuleImage* chromeballImageioOpen(
    const char* format, const uint8_t* file, size_t bytes, const char* name) {
  return new chromeball::OpenedImage(format, {file, bytes}, name);
}
