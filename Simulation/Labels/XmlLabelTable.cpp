#include "Labels/CsvFile.h"
#include "Labels/ReadNifti.h"

#include <pugixml.hpp>

#include <utility>

namespace sono {

namespace {

LabelInfo labelFromElement(const pugi::xml_node& element)
{
  LabelInfo label;
  label.name = element.child_value();
  const auto key = parseNumber(element.attribute("Key").value());
  label.id = key && *key >= 0.0 && *key <= 65535.0 ? int(*key) : -1;
  const char* const channels[] = { "Red", "Green", "Blue" };
  label.hasColor = true;
  for (std::size_t c = 0; c < 3; ++c)
  {
    const auto value = parseNumber(element.attribute(channels[c]).value());
    label.hasColor = label.hasColor && value && *value >= 0.0 && *value <= 1.0;
    label.color[c] = label.hasColor ? float(*value) : label.color[c];
  }
  if (!label.hasColor)
  {
    label.color = LabelInfo().color;
  }
  return label;
}

} // namespace

std::vector<LabelInfo> labelsFromXml(const std::string& xml)
{
  std::vector<LabelInfo> labels;
  pugi::xml_document document;
  // Of a text that breaks off or goes on with other bytes, as header extensions are padded, it keeps what came before.
  document.load_buffer(xml.data(), xml.size(), pugi::parse_default | pugi::parse_trim_pcdata);
  for (const pugi::xpath_node& element : document.select_nodes("//Label"))
  {
    LabelInfo label = labelFromElement(element.node());
    if (label.id >= 0)
    {
      labels.push_back(std::move(label));
    }
  }
  return labels;
}

} // namespace sono
