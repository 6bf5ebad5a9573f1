#include "SonoKeptArrays.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <cstdint>
#include <cstring>

namespace sono {
namespace {

void append(std::int64_t number, std::string& bytes)
{
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

void append(const std::string& text, std::string& bytes)
{
  append(std::int64_t(text.size()), bytes);
  bytes += text;
}

/// Takes what was appended, in the same order; `good` until something is not there.
struct Taker
{
  const std::string& bytes;
  std::size_t at = 0;
  bool good = true;

  std::int64_t number()
  {
    std::int64_t value = 0;
    good = good && bytes.size() - at >= sizeof(value);
    if (good)
    {
      std::memcpy(&value, bytes.data() + at, sizeof(value));
      at += sizeof(value);
    }
    return value;
  }
  std::string text()
  {
    const std::int64_t count = number();
    good = good && count >= 0 && std::uint64_t(count) <= bytes.size() - at;
    const std::string value = good ? bytes.substr(at, std::size_t(count)) : std::string();
    at += value.size();
    return value;
  }
};

std::string nameOf(vtkAbstractArray* array)
{
  return array->GetName() ? array->GetName() : "";
}

} // namespace

std::string packedArrays(vtkFieldData* arrays)
{
  std::string bytes;
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = arrays->GetAbstractArray(i);
    auto* numbers = vtkDataArray::SafeDownCast(array);
    auto* strings = vtkStringArray::SafeDownCast(array);
    append(nameOf(array), bytes);
    append(numbers ? numbers->GetDataType() : VTK_STRING, bytes);
    append(array->GetNumberOfComponents(), bytes);
    if (numbers)
    {
      const auto* values = static_cast<const char*>(numbers->GetVoidPointer(0));
      append(std::string(values, std::size_t(numbers->GetNumberOfValues()) * numbers->GetDataTypeSize()), bytes);
      continue;
    }
    const vtkIdType count = strings ? strings->GetNumberOfValues() : 0;
    append(count, bytes);
    for (vtkIdType n = 0; n < count; ++n)
    {
      append(strings->GetValue(n), bytes);
    }
  }
  return bytes;
}

bool addPackedArrays(const std::string& bytes, vtkFieldData* arrays)
{
  Taker taker{ bytes };
  while (taker.good && taker.at < bytes.size())
  {
    const std::string name = taker.text();
    const int type = int(taker.number());
    const int components = int(taker.number());
    const auto array = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(type));
    if (!taker.good || !array || components < 1)
    {
      return false;
    }
    array->SetName(name.c_str());
    array->SetNumberOfComponents(components);
    if (auto* numbers = vtkDataArray::SafeDownCast(array))
    {
      const std::string values = taker.text();
      numbers->SetNumberOfTuples(vtkIdType(values.size() / numbers->GetDataTypeSize() / components));
      std::memcpy(numbers->GetVoidPointer(0), values.data(),
                  std::size_t(numbers->GetNumberOfValues()) * numbers->GetDataTypeSize());
    }
    else if (auto* strings = vtkStringArray::SafeDownCast(array))
    {
      for (std::int64_t left = taker.number(); taker.good && left > 0; --left)
      {
        strings->InsertNextValue(taker.text());
      }
    }
    arrays->AddArray(array);
  }
  return taker.good;
}

std::string packedSentences(const std::vector<std::string>& sentences)
{
  std::string bytes;
  for (const std::string& sentence : sentences)
  {
    append(sentence, bytes);
  }
  return bytes;
}

std::vector<std::string> unpackedSentences(const std::string& bytes)
{
  Taker taker{ bytes };
  std::vector<std::string> sentences;
  while (taker.good && taker.at < bytes.size())
  {
    sentences.push_back(taker.text());
  }
  return sentences;
}

} // namespace sono
