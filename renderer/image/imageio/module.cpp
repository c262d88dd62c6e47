// SPDX-License-Identifier: Apache-2.0
// libchromeball_imageio.so: files that OpenImageIO reads.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

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
               .channels = spec.channelnames,
               .integerBits = spec.format.is_floating_point() ? 0 : int(8 * spec.format.basesize()),
               .alphaChannel = spec.alpha_channel,
               .unassociatedAlpha =
                   spec.alpha_channel >= 0 && spec.get_int_attribute("oiio:UnassociatedAlpha") != 0,
               .bytes = spec.image_bytes(true)};
  }

  const ModuleImageHeader& header() const override { return header_; }

  void read(float* texels) override {
    if (!input_->read_image(0, 0, 0, input_->spec().nchannels, OIIO::TypeDesc::FLOAT, texels))
      throw std::runtime_error(input_->geterror());
  }

 private:
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

extern "C" [[gnu::visibility("default")]] chromeball::ModuleImage* chromeballImageioOpen(
    const char* format, const uint8_t* file, size_t bytes, const char* name) {
  return new chromeball::OpenedImage(format, {file, bytes}, name);
}
