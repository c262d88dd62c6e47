// SPDX-License-Identifier: Apache-2.0
// The format of an image file, by its first bytes: many files have a wrong name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"

namespace chromeball {

enum class ImageFormat { Exr, RadianceHdr, Pfm, Png, Jpeg, Webp, Tiff, Unknown };

ImageFormat imageFormat(std::span<const uint8_t> firstBytes);
ImageFormat imageFormat(const std::filesystem::path& path);  // InputError if it cannot be read

inline std::string_view textOf(std::span<const uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// A number of at most eight bytes, the most significant first.
inline uint64_t bigEndian(std::span<const uint8_t> bytes) {
  uint64_t number = 0;
  for (const uint8_t byte : bytes) number = number << 8 | byte;
  return number;
}

// Turns exceptions of readers' libraries about a damaged file into an InputError of one line.

// Throws a library's message about `path` as an InputError of one line.
[[noreturn]] void throwUnreadable(const std::filesystem::path& path, std::string reason);

// Whether the system has refused a thread or memory: no fault of the file.
bool isOfResources(const std::exception& error);

// Calls read(), which calls a library. Throws RunError if memory or threads are short.
template <class Read>
auto readByLibrary(const std::filesystem::path& path, const Read& read) {
  try {
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const RunError&) {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const std::bad_alloc&) {  // the texels were within the limit of memory
    throwRun("{}: out of memory while it is read", path.string());
  } catch (const std::exception& error) {
    if (isOfResources(error)) throwRun("{}: while it is read: {}", path.string(), error.what());
    throwUnreadable(path, error.what());
  }
}

}  // namespace chromeball
