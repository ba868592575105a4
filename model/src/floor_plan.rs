//! Floor plans: hallways with geometry, and the embedded graph that they are. Section 2.4.
