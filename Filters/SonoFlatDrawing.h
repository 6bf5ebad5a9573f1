#pragma once

#include "vtkNew.h"

#include <array>
#include <string>
#include <vector>

class vtkCellArray;
class vtkIntArray;
class vtkPoints;
class vtkPolyData;
class vtkUnsignedCharArray;

namespace sono {

/// Strokes, surfaces and letters in the plane of a flat image, in mm, x lateral and y depth, which runs down; a hair in
/// front of the image as seen with the transducer on top. What is drawn belongs to a part, a number of the drawer's,
/// and has a colour.
class FlatDrawing
{
public:
  using Color = std::array<unsigned char, 3>;
  enum class Align
  {
    Left,
    Centre,
    Right
  };

  FlatDrawing();
  ~FlatDrawing();

  /// Of what is drawn from now on.
  void setPart(int part) { part_ = part; }
  void setColor(const Color& color) { color_ = color; }

  void stroke(double x0, double y0, double x1, double y1);
  void closedLine(const std::vector<std::array<double, 2>>& corners);
  void disc(double x, double y, double radius);
  void rectangle(double x0, double y0, double x1, double y1);
  /// Its middle at `y`, digits of this height; its left end, centre or right end at `x`.
  void text(const std::string& content, double x, double y, double height, Align align);

  /// Points, lines, polygons, and the cell arrays "Part" and "Color", RGB.
  void finish(vtkPolyData* polyData);

private:
  struct Cells
  {
    Cells();
    ~Cells();
    vtkNew<vtkCellArray> cells;
    vtkNew<vtkIntArray> parts;
    vtkNew<vtkUnsignedCharArray> colors;
  };

  long long point(double x, double y);
  void take(Cells& cells) const;

  int part_ = 0;
  Color color_{ 217, 217, 217 };
  vtkNew<vtkPoints> points_;
  Cells lines_;
  Cells polygons_;
};

} // namespace sono
