#include "Labels/CsvFile.h"
#include "Labels/ReadNifti.h"

#include <utility>

namespace sono {

namespace {

/// The value of an attribute inside a start tag; empty when it is not there.
std::string attribute(const std::string& tag, const std::string& name)
{
  for (const char quote : { '"', '\'' })
  {
    const std::string opening = " " + name + "=" + quote;
    const std::size_t at = tag.find(opening);
    if (at != std::string::npos)
    {
      const std::size_t first = at + opening.size();
      const std::size_t last = tag.find(quote, first);
      return last == std::string::npos ? std::string() : tag.substr(first, last - first);
    }
  }
  return {};
}

void replaceAll(std::string& text, const std::string& from, const std::string& to)
{
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
  {
    text.replace(at, from.size(), to);
  }
}

std::string plainText(std::string content)
{
  const std::string opening = "<![CDATA[";
  const std::size_t first = content.find(opening);
  if (first != std::string::npos)
  {
    const std::size_t start = first + opening.size();
    return content.substr(start, content.find("]]>", start) - start);
  }
  const std::pair<const char*, const char*> entities[] = {
    { "&lt;", "<" }, { "&gt;", ">" }, { "&quot;", "\"" }, { "&apos;", "'" }, { "&amp;", "&" } // the last on purpose
  };
  for (const auto& [entity, character] : entities)
  {
    replaceAll(content, entity, character);
  }
  const std::size_t start = content.find_first_not_of(" \t\r\n");
  return start == std::string::npos ? std::string()
                                    : content.substr(start, content.find_last_not_of(" \t\r\n") - start + 1);
}

LabelInfo labelFromTag(const std::string& tag)
{
  LabelInfo label;
  const auto key = parseNumber(attribute(tag, "Key"));
  label.id = key && *key >= 0.0 && *key <= 65535.0 ? int(*key) : -1;
  const char* const channels[] = { "Red", "Green", "Blue" };
  label.hasColor = true;
  for (std::size_t c = 0; c < 3; ++c)
  {
    const auto value = parseNumber(attribute(tag, channels[c]));
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
  const std::string opening = "<Label ";
  const std::string closing = "</Label>";
  for (std::size_t at = xml.find(opening); at != std::string::npos; at = xml.find(opening, at + opening.size()))
  {
    const std::size_t tagEnd = xml.find('>', at);
    const std::size_t end = xml.find(closing, at);
    if (tagEnd == std::string::npos || end == std::string::npos || end < tagEnd)
    {
      break;
    }
    LabelInfo label = labelFromTag(xml.substr(at, tagEnd - at));
    label.name = plainText(xml.substr(tagEnd + 1, end - tagEnd - 1));
    if (label.id >= 0)
    {
      labels.push_back(std::move(label));
    }
  }
  return labels;
}

} // namespace sono
