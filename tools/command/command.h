// SPDX-License-Identifier: Apache-2.0
// A command and its options, for those who add one: handles of CLI11's objects, whose headers are
// half of the code of a file that includes them.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace chromeball {

class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required();
  Option excludes(const Option& other);
  Option excludes(const std::string& name);
  Option inRange(int least, int most);
  Option delimiter(char separator);  // between the values of a list
  Option onePerName();               // of a list: --mask A --mask B, not --mask A B
  Option takesAll();                 // one value per name, of any number of names
  Option words(int count);           // after a name
  Option showsDefault();
  Option typeName(const std::string& name);
  Option group(const std::string& title);  // in the help

 private:
  CLI::Option* option_;
};

class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command addCommand(const std::string& name, const std::string& help);
  // The same for one that runs with arguments, which its options set; they live as long as it does.
  template <class Arguments>
  std::pair<Command, Arguments&> addCommand(const std::string& name, const std::string& help,
                                            void (*run)(const Arguments&)) {
    const auto arguments = std::make_shared<Arguments>();
    return {addCommand(name, help).callback([=] { run(*arguments); }), *arguments};
  }
  template <class Arguments>
  std::pair<Command, Arguments&> addCommand(const std::string& name, const std::string& help,
                                            void (*run)(const Arguments&, const Command&)) {
    const auto arguments = std::make_shared<Arguments>();
    Command command = addCommand(name, help);
    return {command.callback([=] { run(*arguments, command); }), *arguments};
  }

  // An option, or an argument if the name has no dash. `value`, of a type that command.cpp lists,
  // is set when the command line is parsed; it must live until then. Lists grow each time that the
  // option is given; of anything else the last value counts. The help shows the first long name
  // alone (help.h).
  template <class T>
  Option addOption(const std::string& names, T& value, const std::string& help);
  template <class T>
  Option addRequired(const std::string& names, T& value, const std::string& help) {
    return addOption(names, value, help).required();
  }
  template <class T>
  Option addWithDefault(const std::string& names, T& value, const std::string& help) {
    return addOption(names, value, help).showsDefault();
  }
  Option addFlag(const std::string& names, bool& value, const std::string& help);
  // `set` gets the words that follow the name; it may throw.
  using Words = std::vector<std::string>;
  Option addParsedOption(const std::string& names, const std::function<void(const Words&)>& set,
                         const std::string& help);
  // A list in one text: what is given again is added behind a comma.
  Option addJoinedOption(const std::string& names, std::string& value, const std::string& help);
  // --NAME or --NAME=VALUE: with "true" or the value. The next word is not the value.
  Option addFlagWithValue(const std::string& names,
                          const std::function<void(const std::string&)>& set,
                          const std::string& help);

  Command callback(const std::function<void()>& run);
  Command requiresCommand();
  Command footer(const std::string& text);  // of the help
  // The help shows, of the options in groups, these alone, after the examples; `--help all` shows
  // all.
  Command briefHelp(const std::vector<std::string>& options, const std::string& examples = "");
  Command widerNames();  // in the help

  bool has(const std::string& option) const;  // was it given?
  // Throws InputError, "OPTION: WHY", for the first of these that was given.
  void refuse(std::initializer_list<const char*> options, const std::string& why) const;

 private:
  CLI::App* app_;
};

}  // namespace chromeball
