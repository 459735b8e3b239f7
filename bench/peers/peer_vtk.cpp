// vtkQuadricDecimation with its default settings, on positions alone.
#include "peers/peer_main.h"

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>

namespace {

exchange::Mesh simplify(const exchange::Mesh& in, std::size_t target, const Timed& timed) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (std::size_t v = 0; v < in.vertex_count(); ++v) points->InsertNextPoint(&in.positions[3 * v]);
  vtkNew<vtkCellArray> triangles;
  for (std::size_t t = 0; t < in.triangle_count(); ++t) {
    const std::uint32_t* c = &in.corners[3 * t];
    const vtkIdType ids[3] = {c[0], c[1], c[2]};
    triangles->InsertNextCell(3, ids);
  }
  vtkNew<vtkPolyData> mesh;
  mesh->SetPoints(points);
  mesh->SetPolys(triangles);

  vtkNew<vtkQuadricDecimation> decimation;
  decimation->SetInputData(mesh);
  decimation->SetTargetReduction(1.0 - double(target) / double(in.triangle_count()));
  timed([&] { decimation->Update(); });

  exchange::Mesh out;
  vtkPolyData* result = decimation->GetOutput();
  for (vtkIdType v = 0; v < result->GetNumberOfPoints(); ++v) {
    const double* p = result->GetPoint(v);
    out.positions.insert(out.positions.end(), p, p + 3);
  }
  vtkNew<vtkIdList> ids;
  vtkCellArray* cells = result->GetPolys();
  cells->InitTraversal();
  while (cells->GetNextCell(ids)) {
    if (ids->GetNumberOfIds() != 3) continue;
    for (vtkIdType i = 0; i < 3; ++i) {
      out.corners.push_back(static_cast<std::uint32_t>(ids->GetId(i)));
    }
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  return peer_main(argc, argv, simplify);
}
