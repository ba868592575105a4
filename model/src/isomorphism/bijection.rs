//! The witness of an isomorphism: a bijection of darts, and its verifier.

use crate::embedded_graph::{Dart, EmbeddedGraph, NO_DART};

/// The image of each dart of one embedded graph in another.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bijection(Vec<Dart>);

impl Bijection {
    /// The given images, in the order of the darts' numbers. Whether they are an isomorphism is for
    /// [`verify`](Self::verify) to check.
    pub fn claimed(images: Vec<Dart>) -> Self {
        Self(images)
    }

    /// The only candidate for an isomorphism of two starts: it maps facing to facing and keeps
    /// `clockwise` and `opposite`. [`verify`](Self::verify) checks whether it is one. Linear time.
    pub fn of_starts(from: (&EmbeddedGraph, Dart), to: (&EmbeddedGraph, Dart)) -> Self {
        let mut candidate = Candidate::default();
        candidate.of_starts(from, to);
        candidate.bijection
    }

    /// The image of a dart; `None` if the dart does not exist.
    pub fn image(&self, dart: Dart) -> Option<Dart> {
        self.0.get(dart.at()).copied()
    }

    pub fn images(&self) -> &[Dart] {
        &self.0
    }

    /// Whether this is an isomorphism from one embedded graph to the other. The check is independent
    /// of how the bijection was found.
    ///
    /// It checks for every dart that its image exists, and that `opposite` and `clockwise` are kept.
    /// This makes it a bijection too: the images are closed under both, so in a connected graph they
    /// are all of its darts, and both graphs have the same number of darts.
    // paper: world.isomorphic
    pub fn verify(&self, from: &EmbeddedGraph, to: &EmbeddedGraph) -> bool {
        from.dart_count() == to.dart_count()
            && self.0.len() == from.dart_count()
            && self.0.iter().all(|image| image.at() < to.dart_count())
            && from.darts().all(|dart| {
                let image = self.0[dart.at()];
                self.0[from.opposite(dart).at()] == to.opposite(image)
                    && self.0[from.clockwise(dart).at()] == to.clockwise(image)
            })
    }
}

/// Makes one candidate bijection after another in the same memory.
#[derive(Clone, Debug, Default)]
pub struct Candidate {
    pub bijection: Bijection,
    /// Darts and their images, from which the rest is found.
    reached: Vec<(Dart, Dart)>,
}

impl Candidate {
    /// [`Bijection::of_starts`], in the memory of the candidate before.
    pub fn of_starts(
        &mut self,
        (from, facing): (&EmbeddedGraph, Dart),
        (to, facing_image): (&EmbeddedGraph, Dart),
    ) -> &Bijection {
        let image = &mut self.bijection.0;
        image.clear();
        image.resize(from.dart_count(), NO_DART);
        self.reached.clear();
        self.reached.push((facing, facing_image));
        // Vertex by vertex: all darts around it, and then the opposite of each.
        let mut next = 0;
        while let Some(&(entry, entry_image)) = self.reached.get(next) {
            next += 1;
            let (mut dart, mut at) = (entry, entry_image);
            while image[dart.at()] == NO_DART {
                image[dart.at()] = at;
                let far = from.opposite(dart);
                if image[far.at()] == NO_DART {
                    self.reached.push((far, to.opposite(at)));
                }
                dart = from.clockwise(dart);
                at = to.clockwise(at);
            }
        }
        &self.bijection
    }
}
