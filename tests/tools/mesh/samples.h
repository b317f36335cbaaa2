// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

// The same two tetrahedra in each text format: nodes 10, 2, 30, 4, 50 in this order (numbers neither
// contiguous nor ascending) where the format has numbers, tetrahedra on either side of the face of the last
// four.
namespace palpate::mesh::test {

inline const std::string kMsh1 = R"($NOD
6
10 0 0 0
2 1 0 0
99 7 7 7
30 0 1 0
4 0 0 1
50 1 1 1
$ENDNOD
$ELM
4
1 1 5 5 2 10 2
2 2 6 6 3 2 30 4
3 4 0 1 4 10 2 30 4
8 4 7 1 4 2 30 4 50
$ENDELM
)";

inline const std::string kMsh2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 6 "lower face"
3 7 "upper"
$EndPhysicalNames
$Nodes
6
10 0 0 0
2 1 0 0
99 7 7 7
30 0 1 0
4 0 0 1
50 1 1 1
$EndNodes
$Elements
5
1 1 2 6 5 10 2
2 2 2 6 6 2 30 4
3 4 2 0 1 10 2 30 4
8 4 4 7 1 1 0 2 30 4 50
9 15 2 6 1 50
$EndElements
$NodeData
anything at all
$EndNodeData
)";

inline const std::string kMsh4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
2 6 "lower face"
$EndPhysicalNames
$Entities
1 0 1 2
1 0 0 0 1 9
1 0 0 0 1 1 1 2 6 11 0
1 0 0 0 1 1 1 0 1 1
2 0 0 0 1 1 1 1 -7 1 -1
$EndEntities
$Nodes
2 6 2 99
3 1 0 4
10
2
99
30
0 0 0
1 0 0
7 7 7
0 1 0
2 1 1 2
4
50
0 0 1 0.5 0.5
1 1 1 0.5 0.5
$EndNodes
$Elements
4 4 1 8
0 1 15 1
1 50
2 1 2 1
2 2 30 4
3 1 4 1
3 10 2 30 4
3 2 4 1
8 2 30 4 50
$EndElements
)";

inline const std::string kVtk = R"(# vtk DataFile Version 3.0
two tetrahedra
ASCII
DATASET UNSTRUCTURED_GRID
FIELD FieldData 1
TIME 1 1 double
0.5
POINTS 6 float
0 0 0 1 0 0 7 7 7
0 1 0 0 0 1 1 1 1
CELLS 3 14
3 1 3 4
4 0 1 3 4
4 1 3 4 5
CELL_TYPES 3
5
10
10
CELL_DATA 3
SCALARS id int 1
LOOKUP_TABLE default
1 2 3
)";

inline const std::string kVtk5 = R"(# vtk DataFile Version 5.1
two tetrahedra
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 6 double
0 0 0 1 0 0 7 7 7
0 1 0 0 0 1 1 1 1
METADATA
INFORMATION 0

CELLS 3 8
OFFSETS vtktypeint64
0 4 8
CONNECTIVITY vtktypeint64
0 1 3 4 1 3 4 5
CELL_TYPES 2
10 10
)";

inline const std::string kMedit = R"(MeshVersionFormatted 2
# two tetrahedra
Dimension 3
Vertices
6
0 0 0 0
1 0 0 0
7 7 7 0
0 1 0 0
0 0 1 0
1 1 1 3
Triangles 1
2 4 5 6
Ridges
1
2
Normals
1
-0.5 1.0e0 0
Tetrahedra
2
1 2 4 5 0
2 4 5 6 7
End
)";

}  // namespace palpate::mesh::test
