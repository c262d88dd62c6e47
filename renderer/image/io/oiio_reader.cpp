// SPDX-License-Identifier: Apache-2.0
#include "image/io/oiio_reader.h"

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <string_view>

#include "image/io/strip_metadata.h"

namespace chromeball {
namespace {

std::vector<uint8_t> stripMetadata(std::string_view reader, std::span<const uint8_t> file,
                                   const std::string& name, const CheckSize& check) {
  if (reader == "png") return stripPng(file);
  if (reader == "tiff") return stripTiff(file);
  StrippedJpeg jpeg = stripJpeg(file, name);
  check(jpeg.width, jpeg.height, jpeg.components);
  return std::move(jpeg.file);
}

}  // namespace

const char* readerFor(std::span<const uint8_t> firstBytes) {
  constexpr std::pair<std::string_view, const char*> kReaders[] = {
      {"\x76\x2f\x31\x01", "openexr"},
      {"\x89PNG", "png"},
      {"\xff\xd8\xff", "jpeg"},
      {std::string_view("II*\0", 4), "tiff"},
      {std::string_view("MM\0*", 4), "tiff"},
      {std::string_view("II+\0", 4), "tiff"},
      {std::string_view("MM\0+", 4), "tiff"}};
  const std::string_view bytes(reinterpret_cast<const char*>(firstBytes.data()), firstBytes.size());
  for (const auto& [magic, reader] : kReaders)
    if (bytes.starts_with(magic)) return reader;
  return nullptr;
}

// The reader is given by name, because OpenImageIO passes a file that one reader rejects to all
// others in turn, among them readers of film, camera and medical formats; one of these allocates
// 2 GB for a file of 400 bytes. The mutex is needed because version 2.4 looks up ICC and EXIF tags
// in tables that the look-up itself extends without a lock (OpenImageIO's issue 3756).
std::unique_ptr<OIIO::ImageInput> openImage(const char* reader, const std::string& path,
                                            const OIIO::ImageSpec& config) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  auto input = OIIO::ImageInput::create(reader);
  if (!input) throw std::runtime_error(OIIO::geterror());
  OIIO::ImageSpec spec;
  if (!input->open(path, spec, config)) throw std::runtime_error(input->geterror());
  return input;
}

MemoryInput::MemoryInput(const char* reader, std::span<const uint8_t> file, const std::string& name,
                         const CheckSize& check, OIIO::ImageSpec config)
    : file_(stripMetadata(reader, file, name, check)), memory_(file_.data(), file_.size()) {
  OIIO::Filesystem::IOProxy* proxy = &memory_;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  input_ = openImage(reader, name, config);
  const OIIO::ImageSpec& spec = input_->spec();
  check(spec.width, spec.height, spec.nchannels);
}

}  // namespace chromeball
