//! Reading plantri's codes, one world after the other.

use super::{PlantriCode, PlantriError, PlantriErrorKind};
use crate::embedded_graph::{EmbeddedGraph, GraphError, MAX_EDGES};

/// The byte order of the numbers of `planar_code` with two bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ByteOrder {
    Little,
    Big,
    Unknown,
}

const HEADERS: [(&[u8], PlantriCode, ByteOrder); 4] = [
    (b">>planar_code<<", PlantriCode::Planar, ByteOrder::Unknown),
    (b">>planar_code le<<", PlantriCode::Planar, ByteOrder::Little),
    (b">>planar_code be<<", PlantriCode::Planar, ByteOrder::Big),
    (b">>edge_code<<", PlantriCode::Edge, ByteOrder::Unknown),
];

/// The worlds of a file in order. The iterator ends after the first error.
///
/// Reading a world takes at most 128 bytes of memory for each byte of it.
#[derive(Clone, Debug)]
pub struct Worlds<'a> {
    bytes: &'a [u8],
    next: usize,
    read: usize,
    code: PlantriCode,
    order: ByteOrder,
    done: bool,
}

/// The worlds of a file. The header gives the code; without one it is `planar_code`. There may be
/// headers between worlds, as in files joined together.
///
/// Vertices are numbered in the order of the file, and the darts of each in the order in which it
/// lists them.
pub fn read(bytes: &[u8]) -> Worlds<'_> {
    read_headerless(bytes, PlantriCode::Planar)
}

/// The worlds of a file: as [`read`], but without a header it has this code.
pub fn read_headerless(bytes: &[u8], code: PlantriCode) -> Worlds<'_> {
    Worlds { bytes, next: 0, read: 0, code, order: ByteOrder::Unknown, done: false }
}

impl Iterator for Worlds<'_> {
    type Item = Result<EmbeddedGraph, PlantriError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.done {
            return None;
        }
        let result = self.take_header().and_then(|()| self.world());
        let error = |(offset, cause)| PlantriError { offset, world: self.read + 1, cause };
        match result.map_err(error).transpose()? {
            Ok((graph, next)) => {
                self.next = next;
                self.read += 1;
                Some(Ok(graph))
            }
            Err(error) => {
                self.done = true;
                Some(Err(error))
            }
        }
    }
}

type Failure = (usize, PlantriErrorKind);

impl Worlds<'_> {
    /// Skips a header. A header is not confused with a world: a world that begins with `>>` has 62
    /// vertices, or a body of 62 bytes and so at most 31 edges, less than its letters.
    fn take_header(&mut self) -> Result<(), Failure> {
        let rest = &self.bytes[self.next..];
        let is_header = rest.starts_with(b">>") && rest.get(2).is_some_and(u8::is_ascii_lowercase);
        if !is_header {
            return Ok(());
        }
        match HEADERS.iter().find(|(header, ..)| rest.starts_with(header)) {
            Some(&(header, code, order)) => {
                self.next += header.len();
                self.code = code;
                self.order = order;
                Ok(())
            }
            None => Err((self.next, PlantriErrorKind::UnknownHeader)),
        }
    }

    /// The next world and the byte after it; `None` at the end of the file.
    fn world(&self) -> Result<Option<(EmbeddedGraph, usize)>, Failure> {
        let at_end = self.next == self.bytes.len();
        match (at_end, self.code) {
            (true, _) if self.read == 0 => Err((self.next, PlantriErrorKind::Empty)),
            (true, _) => Ok(None),
            (false, PlantriCode::Planar) => self.planar_code().map(Some),
            (false, PlantriCode::Edge) => self.edge_code().map(Some),
        }
    }

    fn planar_code(&self) -> Result<(EmbeddedGraph, usize), Failure> {
        let mut cursor = Cursor { bytes: self.bytes, at: self.next };
        if cursor.bytes[cursor.at] != 0 {
            return planar_code(cursor, 1, ByteOrder::Big);
        }
        cursor.at += 1;
        match self.order {
            ByteOrder::Unknown => planar_code(cursor, 2, ByteOrder::Little).or_else(|little| {
                // If both orders fail, the error that is farther in the file is the better one.
                planar_code(cursor, 2, ByteOrder::Big)
                    .map_err(|big| if big.0 > little.0 { big } else { little })
            }),
            order => planar_code(cursor, 2, order),
        }
    }

    fn edge_code(&self) -> Result<(EmbeddedGraph, usize), Failure> {
        let mut cursor = Cursor { bytes: self.bytes, at: self.next };
        let (length, edge_bytes) = match cursor.number(1, ByteOrder::Big)? {
            0 => {
                let sizes_at = cursor.at;
                let sizes = cursor.number(1, ByteOrder::Big)? as u8;
                let (length_bytes, edge_bytes) = (sizes >> 4, sizes & 15);
                if length_bytes == 0 || edge_bytes == 0 {
                    return Err((sizes_at, PlantriErrorKind::Sizes { length_bytes, edge_bytes }));
                }
                let length = cursor.number(length_bytes.into(), ByteOrder::Big)?;
                (length, usize::from(edge_bytes))
            }
            length => (length, 1),
        };
        let end = usize::try_from(length)
            .ok()
            .and_then(|length| cursor.at.checked_add(length))
            .filter(|&end| end <= self.bytes.len())
            .ok_or((self.bytes.len(), PlantriErrorKind::Truncated))?;
        cursor.bytes = &self.bytes[..end];
        Ok((edge_code(cursor, edge_bytes)?, end))
    }
}

#[derive(Clone, Copy)]
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Cursor<'_> {
    /// The next number; the greatest one if it does not fit.
    fn number(&mut self, size: usize, order: ByteOrder) -> Result<u64, Failure> {
        let bytes = self.at.checked_add(size).and_then(|end| self.bytes.get(self.at..end));
        let bytes = bytes.ok_or((self.bytes.len(), PlantriErrorKind::Truncated))?;
        self.at += size;
        let add = |number: u64, &byte: &u8| match number.checked_mul(256) {
            Some(shifted) => shifted | u64::from(byte),
            None => u64::MAX,
        };
        Ok(match order {
            ByteOrder::Little => bytes.iter().rev().fold(0, add),
            ByteOrder::Big | ByteOrder::Unknown => bytes.iter().fold(0, add),
        })
    }
}

/// Reads a `planar_code` from its number of vertices on.
fn planar_code(
    mut cursor: Cursor<'_>,
    size: usize,
    order: ByteOrder,
) -> Result<(EmbeddedGraph, usize), Failure> {
    let start = cursor.at;
    let vertices = cursor.number(size, order)? as usize;
    let lists = cursor.at;
    let mut darts: Vec<(u32, u32)> = Vec::new();
    let mut firsts = Vec::new();
    for vertex in 0..vertices {
        firsts.push(darts.len() as u32);
        loop {
            let at = cursor.at;
            let neighbour = cursor.number(size, order)? as usize;
            if neighbour == 0 {
                break;
            }
            if neighbour > vertices {
                let vertex = vertex + 1;
                return Err((
                    at,
                    PlantriErrorKind::UnknownNeighbour { vertex, neighbour, vertices },
                ));
            }
            darts.push((vertex as u32, neighbour as u32 - 1));
        }
    }
    check_size(start, darts.len())?;
    // The byte of a dart: one number for each dart and each list before it.
    let place = |dart: usize| lists + size * (dart + darts[dart].0 as usize);
    let mut sorted: Vec<u32> = (0..darts.len() as u32).collect();
    sorted.sort_unstable_by_key(|&dart| (darts[dart as usize], dart));
    let again = sorted
        .windows(2)
        .filter(|pair| darts[pair[0] as usize] == darts[pair[1] as usize])
        .map(|pair| pair[1] as usize);
    let loops = (0..darts.len()).filter(|&dart| darts[dart].0 == darts[dart].1);
    if let Some(dart) = again.chain(loops).min() {
        let (vertex, neighbour) = numbers(darts[dart]);
        return Err((place(dart), PlantriErrorKind::NotSimple { vertex, neighbour }));
    }
    let opposite = (0..darts.len())
        .map(|dart| {
            let (vertex, neighbour) = darts[dart];
            sorted
                .binary_search_by_key(&(neighbour, vertex), |&other| darts[other as usize])
                .map(|at| sorted[at])
                .map_err(|_| {
                    let (vertex, neighbour) = numbers(darts[dart]);
                    (place(dart), PlantriErrorKind::OneSided { vertex, neighbour })
                })
        })
        .collect::<Result<Vec<_>, _>>()?;
    Ok((graph(start, &opposite, &firsts)?, cursor.at))
}

const UNMET: u32 = u32::MAX;

/// Reads the body of an `edge_code`, which reaches to the end of the cursor's bytes.
fn edge_code(mut cursor: Cursor<'_>, size: usize) -> Result<EmbeddedGraph, Failure> {
    let start = cursor.at;
    let mut ends: Vec<u64> = Vec::new();
    let mut firsts = vec![0];
    while let Some(&byte) = cursor.bytes.get(cursor.at) {
        if byte == 255 {
            cursor.at += 1;
            firsts.push(ends.len() as u32);
        } else {
            let at = cursor.at;
            let half = |_| (at, PlantriErrorKind::HalfEdgeNumber);
            ends.push(cursor.number(size, ByteOrder::Big).map_err(half)?);
        }
    }
    // The byte of a dart: one separator for each list before its vertex.
    let vertex = |dart: usize| firsts.partition_point(|&first| first as usize <= dart) - 1;
    let place = |dart: usize| start + size * dart + vertex(dart);
    check_size(start, ends.len())?;
    if ends.len() % 2 == 1 {
        return Err((start, PlantriErrorKind::OddEnds { ends: ends.len() }));
    }
    let mut first_end = vec![UNMET; ends.len() / 2];
    let mut opposite = vec![UNMET; ends.len()];
    for (dart, &edge) in ends.iter().enumerate() {
        let edges = first_end.len();
        let Some(first) = usize::try_from(edge).ok().and_then(|edge| first_end.get_mut(edge))
        else {
            let cause = PlantriErrorKind::UnknownEdge { vertex: vertex(dart) + 1, edge, edges };
            return Err((place(dart), cause));
        };
        let other = *first as usize;
        if *first == UNMET {
            *first = dart as u32;
        } else if opposite[other] == UNMET {
            opposite[other] = dart as u32;
            opposite[dart] = *first;
        } else {
            return Err((place(dart), PlantriErrorKind::ThirdEnd { edge }));
        }
    }
    graph(start, &opposite, &firsts)
}

/// Rejects more darts than can be numbered, before anything is numbered.
fn check_size(start: usize, darts: usize) -> Result<(), Failure> {
    if darts / 2 > MAX_EDGES {
        return Err((start, GraphError::TooManyEdges.into()));
    }
    Ok(())
}

/// The vertex and its neighbour as the code counts them.
fn numbers((vertex, neighbour): (u32, u32)) -> (usize, usize) {
    (vertex as usize + 1, neighbour as usize + 1)
}

/// The graph of vertices whose darts begin at `firsts`, of the world at `start`.
fn graph(start: usize, opposite: &[u32], firsts: &[u32]) -> Result<EmbeddedGraph, Failure> {
    let darts = opposite.len() as u32;
    let ends = firsts.iter().skip(1).copied().chain([darts]);
    let lists: Vec<_> = firsts.iter().copied().zip(ends).collect();
    let without_edge = lists.iter().position(|(first, end)| first == end);
    if let Some(vertex) = without_edge.filter(|_| darts > 0) {
        return Err((start, PlantriErrorKind::NoEdge { vertex: vertex + 1 }));
    }
    let mut clockwise: Vec<u32> = (1..=darts).collect();
    for &(first, end) in lists.iter().filter(|(first, end)| first < end) {
        clockwise[end as usize - 1] = first;
    }
    match EmbeddedGraph::from_permutations(opposite, &clockwise) {
        Ok((graph, _)) => Ok(graph),
        Err(GraphError::NotConnected { dart }) => {
            let vertex = firsts.partition_point(|&first| first <= dart);
            Err((start, PlantriErrorKind::NotConnected { vertex }))
        }
        Err(fault) => Err((start, fault.into())),
    }
}
