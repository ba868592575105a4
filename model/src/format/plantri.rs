//! plantri's `planar_code` and `edge_code`.
