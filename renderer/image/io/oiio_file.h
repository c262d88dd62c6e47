// SPDX-License-Identifier: Apache-2.0
// What the readers of whole files and of rows share: errors, attributes and checks of what
// OpenImageIO opened.
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <new>
#include <string>
#include <string_view>

#include "base/error.h"
#include "image/io/read_image.h"
#include "image/io/silenced_stderr.h"

namespace chromeball {

// Throws OpenImageIO's message about `path` as an InputError of one line.
[[noreturn]] void throwUnreadable(const std::filesystem::path& path, std::string reason);

Metadata metadataOf(const OIIO::ImageSpec& spec);

// Throws InputError if the file is too short for the image that its header claims. `reader`: as
// readerFor() names it.
void checkFileLength(const std::filesystem::path& path, std::string_view reader,
                     const OIIO::ImageSpec& spec);

// Calls read(), which calls OpenImageIO. What that throws about a damaged file becomes an
// InputError, and what it prints is not shown.
template <class Read>
auto readByOiio(const std::filesystem::path& path, const Read& read) {
  try {
    const SilencedStderr silenced;
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throwUnreadable(path, "its header claims more texels than fit into memory");
  } catch (const std::exception& error) {
    throwUnreadable(path, error.what());
  }
}

}  // namespace chromeball
