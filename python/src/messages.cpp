// SPDX-License-Identifier: Apache-2.0
#include "messages.h"

#include "front/scene_values.h"

namespace chromeball::python {

std::string inWords(const std::optional<Remedy>& remedy) {
  if (!remedy) return "";
  const std::string keyword = keywordOf(remedy->setting);
  return remedy->value.empty() ? fmt::format("; see {}", keyword)
                               : fmt::format("; try {}={}", keyword, remedy->value);
}

std::vector<std::pair<std::string, std::string>> pairsOf(const Messages& messages) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const Message& message : condensed(messages))
    pairs.emplace_back(message.kind == Message::Kind::Warning ? "warning" : "note",
                       message.text + inWords(message.remedy));
  return pairs;
}

}  // namespace chromeball::python
