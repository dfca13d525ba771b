"""The rod model held against closed forms, published benchmarks and 3D, level by level; and the 3D reference itself."""
