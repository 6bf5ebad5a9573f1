// Writes ParaView's descriptions of the filters at build time. In the XML files of Plugin,
//
//   <Parameters of="TraceSettings" simple="PathsPerLine"/>  stands for a property of each parameter of that struct,
//   <Exposed of="TraceSettings" simple="PathsPerLine"/>     for the names of the same properties of a sub-proxy.
//
// `only` and `except` choose among them, `simple` are those that a panel always shows, `where` is a switch (0 off,
// 1 on, 2 automatic) without which it shows none of them. `method` takes the name and the value, in place of one method
// a property.
#include "Channels/ChannelSettings.h"
#include "ChestDefaults.h"
#include "Echo/EchoSettings.h"
#include "Image/BModeSettings.h"
#include "Image/DisplaySettings.h"
#include "Labels/BodyFill.h"
#include "Probe/ScanGeometry.h"
#include "Scene/ScanDetail.h"
#include "SliderRanges.h"
#include "Trace/TraceSettings.h"

#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

using sono::Parameter;

/// A parameter with the type and the default of its member.
struct Described
{
  Parameter parameter;
  std::string name;
  bool isDouble;
  bool isSwitch;
  double value;
  double chestValue; ///< in vtkSonoUltrasound
};

using Attributes = std::map<std::string, std::string>;

template<class Settings, class Visit>
std::vector<Described> describe(const Settings& settings, const Visit& visit)
{
  std::vector<Described> all;
  visit(settings, [&all](const auto& value, const Parameter& parameter) {
    using Value = std::decay_t<decltype(value)>;
    const double number = sono::numberOf(value);
    all.push_back({ parameter, sono::propertyName(parameter), std::is_same_v<Value, double>,
                    std::is_same_v<Value, bool>, number, number });
  });
  return all;
}

template<class Settings>
std::vector<Described> describe()
{
  return describe(Settings(), [](const auto& s, const auto& visitor) { Settings::visit(s, visitor); });
}

template<class Settings>
std::vector<Described> describeWithChest()
{
  Settings chest;
  sono::setChestDefaults(chest);
  std::vector<Described> all = describe<Settings>();
  std::size_t i = 0;
  Settings::visit(chest, [&](const auto& value, const Parameter&) { all[i++].chestValue = sono::numberOf(value); });
  return all;
}

std::vector<Described> parametersOf(const std::string& settings)
{
  static const std::map<std::string, std::function<std::vector<Described>()>> all{
    { "BModeSettings", describeWithChest<sono::BModeSettings> },
    { "BodyFillSettings", describe<sono::BodyFillSettings> },
    { "ChannelSettings", describe<sono::ChannelSettings> },
    { "DisplaySettings", describe<sono::DisplaySettings> },
    { "EchoSettings", describe<sono::EchoSettings> },
    { "EchoSampling",
      [] {
        return describe(sono::EchoSettings(),
                        [](const auto& s, const auto& visitor) { sono::EchoSettings::visitSampling(s, visitor); });
      } },
    { "ProbeSettings", describe<sono::ProbeSettings> },
    { "ScanDetailSettings", describe<sono::ScanDetailSettings> },
    { "ScanGeometry", describe<sono::ScanGeometry> },
    { "TraceSettings", describeWithChest<sono::TraceSettings> },
  };
  return all.at(settings)();
}

bool isIn(const std::string& words, const std::string& word)
{
  return (" " + words + " ").find(" " + word + " ") != std::string::npos;
}

std::vector<Described> chosen(const Attributes& attributes)
{
  std::vector<Described> all;
  const auto only = attributes.find("only");
  const auto except = attributes.find("except");
  for (const Described& d : parametersOf(attributes.at("of")))
  {
    if ((only == attributes.end() || isIn(only->second, d.name)) &&
        (except == attributes.end() || !isIn(except->second, d.name)))
    {
      all.push_back(d);
    }
  }
  return all;
}

std::string shown(const Attributes& attributes, const Described& d)
{
  const auto simple = attributes.find("simple");
  const bool isSimple = simple != attributes.end() && isIn(simple->second, d.name);
  return isSimple ? "default" : "advanced";
}

std::string text(double number)
{
  std::ostringstream stream;
  stream.precision(10);
  stream << number;
  return stream.str();
}

std::string domain(const Described& d)
{
  if (d.isSwitch)
  {
    return "<BooleanDomain name=\"bool\"/>\n";
  }
  std::ostringstream xml;
  if (!d.parameter.choices.empty())
  {
    xml << "<EnumerationDomain name=\"enum\">\n";
    for (std::size_t i = 0; i < d.parameter.choices.size(); ++i)
    {
      xml << "  <Entry value=\"" << i << "\" text=\"" << d.parameter.choices[i] << "\"/>\n";
    }
    xml << "</EnumerationDomain>\n";
    return xml.str();
  }
  const sono::Range& range = d.parameter.range;
  const auto bound = [&xml](const char* name, double value) {
    if (value - value == 0.0) // finite
    {
      xml << " " << name << "=\"" << text(value) << "\"";
    }
  };
  xml << (d.isDouble ? "<DoubleRangeDomain" : "<IntRangeDomain") << " name=\"range\"";
  const auto slider = sono::sliderRanges().find(d.name);
  const bool isWhole = slider == sono::sliderRanges().end(); // a slider over all that is valid
  bound("min", isWhole ? range.low : slider->second.low);
  bound("max", isWhole ? range.high : slider->second.high);
  xml << "/>\n";
  return xml.str();
}

std::string decorator(const std::string& property, const std::string& values)
{
  return "<Hints>\n  <PropertyWidgetDecorator type=\"GenericDecorator\" mode=\"visibility\" property=\"" + property +
         "\" values=\"" + values + "\"/>\n</Hints>\n";
}

/// A number of the scan lines is shown for the kinds that use it.
std::string kindsOf(const Parameter& parameter)
{
  std::string kinds;
  std::size_t count = 0;
  for (std::size_t kind = 0; kind < sono::scanKinds().size(); ++kind)
  {
    sono::ScanGeometry geometry;
    geometry.kind = sono::ScanKind(kind);
    const auto& numbers = sono::scanKinds()[kind].numbers;
    const bool isUsed = std::find(numbers.begin(), numbers.end(), parameter.name) != numbers.end();
    kinds += isUsed ? (kinds.empty() ? "" : " ") + std::to_string(kind) : "";
    count += isUsed;
  }
  return count < sono::scanKinds().size() ? kinds : "";
}

std::string property(const Attributes& attributes, const Described& d)
{
  std::ostringstream xml;
  const std::string element = d.isDouble ? "DoubleVectorProperty" : "IntVectorProperty";
  const auto method = attributes.find("method");
  xml << "<" << element << " name=\"" << d.name << "\" label=\"" << d.parameter.label << "\" command=\""
      << (method != attributes.end() ? method->second : "Set" + d.name) << "\""
      << (method != attributes.end() ? " initial_string=\"" + d.name + "\"" : "")
      << " number_of_elements=\"1\" default_values=\"" << text(d.value) << "\" panel_visibility=\""
      << shown(attributes, d) << "\">\n"
      << domain(d) << "<Documentation>" << d.parameter.sentence << "</Documentation>\n";
  const std::string kinds = attributes.at("of") == "ProbeSettings" ? kindsOf(d.parameter) : "";
  const auto where = attributes.find("where");
  if (where != attributes.end())
  {
    xml << decorator(where->second, "1 2");
  }
  else if (!kinds.empty())
  {
    xml << decorator("ScanKind", kinds);
  }
  xml << "</" << element << ">\n";
  return xml.str();
}

std::string exposed(const Attributes& attributes, const Described& d)
{
  std::string xml = "<Property name=\"" + d.name + "\"";
  if (isIn(attributes.count("from") ? attributes.at("from") : "", "chest") && d.value != d.chestValue)
  {
    // With a default, ParaView reads the label and the number of elements here, too.
    xml += std::string(" label=\"") + d.parameter.label + "\" command=\"Set" + d.name +
           "\" number_of_elements=\"1\" default_values=\"" + text(d.chestValue) + "\"";
  }
  return xml + " panel_visibility=\"" + shown(attributes, d) + "\"/>\n";
}

std::string expand(const std::string& line)
{
  static const std::regex element("\\s*<(Parameters|Exposed) (.*)/>\\s*");
  static const std::regex attribute("(\\w+)=\"([^\"]*)\"");
  std::smatch match;
  if (!std::regex_match(line, match, element))
  {
    return line + "\n";
  }
  const std::string content = match[2];
  Attributes attributes;
  for (std::sregex_iterator it(content.begin(), content.end(), attribute), end; it != end; ++it)
  {
    attributes[(*it)[1]] = (*it)[2];
  }
  std::string xml;
  for (const Described& d : chosen(attributes))
  {
    xml += match[1] == "Exposed" ? exposed(attributes, d) : property(attributes, d);
  }
  return xml;
}

} // namespace

int main(int argc, char** argv)
{
  const std::filesystem::path folder = argv[1];
  for (int i = 2; i < argc; ++i)
  {
    std::ifstream from(argv[i]);
    std::ofstream to(folder / std::filesystem::path(argv[i]).filename());
    for (std::string line; std::getline(from, line);)
    {
      to << expand(line);
    }
    if (!to.flush())
    {
      std::cerr << "cannot describe " << argv[i] << " in " << folder << "\n";
      return 1;
    }
  }
}
