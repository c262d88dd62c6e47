// SPDX-License-Identifier: Apache-2.0
#include "messages.h"

#include "front/scene_values.h"

namespace chromeball::python {

std::string inWords(const std::optional<Remedy>& remedy) {
  if (!remedy) return "";
  return fmt::format("; {} {}", remedy->value.empty() ? "see" : "try",
                     keywordInWords(remedy->setting, remedy->value));
}

std::string keywordInWords(std::string_view setting, const std::string& value) {
  return keywordOf(setting) + (value.empty() ? "" : "=" + value);
}

std::vector<std::pair<std::string, std::string>> pairsOf(const Messages& messages) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const Message& message : condensed(messages))
    pairs.emplace_back(message.kind == Message::Kind::Warning ? "warning" : "note",
                       message.text + inWords(message.remedy));
  return pairs;
}

}  // namespace chromeball::python
