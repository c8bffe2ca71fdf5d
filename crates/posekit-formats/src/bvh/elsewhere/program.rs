//! The programs whose reading is known.

/// A program that reads BVH files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Program {
    /// `BVHLoader` of three.js.
    Three,
    /// Blender's importer, as an armature.
    Blender,
    /// The Python package pybvh.
    Pybvh,
    /// The Python package bvhio.
    Bvhio,
    /// Assimp, which many engines and tools import with.
    Assimp,
}

impl Program {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Three,
        Self::Blender,
        Self::Pybvh,
        Self::Bvhio,
        Self::Assimp,
    ];

    /// The short name, as on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Three => "three",
            Self::Blender => "blender",
            Self::Pybvh => "pybvh",
            Self::Bvhio => "bvhio",
            Self::Assimp => "assimp",
        }
    }

    /// What people call it.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Three => "three.js",
            Self::Blender => "Blender",
            Self::Pybvh => "pybvh",
            Self::Bvhio => "bvhio",
            Self::Assimp => "Assimp",
        }
    }

    /// The version that the rules were tried with.
    #[must_use]
    pub const fn version(self) -> &'static str {
        match self {
            Self::Three => "0.187",
            Self::Blender => "5.0.1",
            Self::Pybvh => "0.9.0",
            Self::Bvhio => "1.5.4",
            Self::Assimp => "5.2.5",
        }
    }

    /// Where in its source the reader is.
    #[must_use]
    pub const fn source(self) -> &'static str {
        match self {
            Self::Three => "examples/jsm/loaders/BVHLoader.js",
            Self::Blender => "scripts/addons_core/io_anim_bvh/import_bvh.py",
            Self::Pybvh => "pybvh/io.py",
            Self::Bvhio => "bvhio/lib/Parser.py",
            Self::Assimp => "code/AssetLib/BVH/BVHLoader.cpp",
        }
    }
}
