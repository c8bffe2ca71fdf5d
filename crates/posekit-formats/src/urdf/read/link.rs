//! Links: what is seen of them, and the materials that their visuals name.

use std::collections::HashMap;

use super::value::{length, numbers, origin, required};
use super::xml::Element;
use crate::report::{ReadError, Reporter, WarningCode, quote};
use crate::urdf::{UrdfLink, UrdfShape, UrdfVisual};

/// What a material says; either may be missing.
#[derive(Clone, Default)]
struct Material {
    color: Option<[f64; 4]>,
    texture: Option<String>,
}

/// The materials that have a name and say something, wherever in the file they stand: the first of a
/// name counts, those of the robot before those inside visuals.
#[derive(Default)]
pub(super) struct Materials(HashMap<String, Material>);

impl Materials {
    pub(super) fn read(
        robot: Element<'_, '_>,
        reporter: &mut Reporter<'_>,
    ) -> Result<Self, ReadError> {
        let mut materials = Self::default();
        for element in robot.children().filter(|child| child.name() == "material") {
            materials.add(element, reporter)?;
        }
        for link in robot.children().filter(|child| child.name() == "link") {
            for visual in link.children().filter(|child| child.name() == "visual") {
                if let Some(element) = visual.child("material") {
                    materials.add(element, reporter)?;
                }
            }
        }
        Ok(materials)
    }

    fn add(
        &mut self,
        element: Element<'_, '_>,
        reporter: &mut Reporter<'_>,
    ) -> Result<(), ReadError> {
        let material = material(element, reporter)?;
        if material.color.is_none() && material.texture.is_none() {
            return Ok(());
        }
        if let Some((name, _)) = element.attribute("name", reporter)? {
            self.0.entry(name.into_owned()).or_insert(material);
        }
        Ok(())
    }

    /// The material of a visual: its own words, or those of the material that it names.
    fn of_visual(
        &self,
        visual: Element<'_, '_>,
        reporter: &mut Reporter<'_>,
    ) -> Result<Material, ReadError> {
        let Some(element) = visual.child("material") else {
            return Ok(Material::default());
        };
        let own = material(element, reporter)?;
        if own.color.is_some() || own.texture.is_some() {
            return Ok(own);
        }
        let Some((name, at)) = element.attribute("name", reporter)? else {
            return Ok(own);
        };
        if name.trim().is_empty() {
            return Ok(own);
        }
        Ok(self.0.get(name.as_ref()).cloned().unwrap_or_else(|| {
            reporter.warn(WarningCode::UnknownMaterial, at, || {
                let name = quote(name.as_bytes());
                format!("no material {name} is described; the visual has no colour")
            });
            own
        }))
    }
}

fn material(element: Element<'_, '_>, reporter: &mut Reporter<'_>) -> Result<Material, ReadError> {
    let mut material = Material::default();
    if let Some(color) = element.child("color") {
        let rgba = numbers(color, "rgba", reporter)?;
        material.color = rgba.map(|rgba: [f64; 4]| rgba.map(|part| part.clamp(0.0, 1.0)));
    }
    if let Some(texture) = element.child("texture") {
        let filename = texture.attribute("filename", reporter)?;
        material.texture = filename.map(|(name, _)| name.into_owned());
    }
    Ok(material)
}

/// A `<link>`.
pub(super) fn read(
    element: Element<'_, '_>,
    materials: &Materials,
    reporter: &mut Reporter<'_>,
) -> Result<UrdfLink, ReadError> {
    let (name, _) = required(element, "name", reporter)?;
    let mut visuals = Vec::new();
    for visual in element.children().filter(|child| child.name() == "visual") {
        visuals.extend(read_visual(visual, materials, reporter)?);
    }
    Ok(UrdfLink {
        name: name.into_owned(),
        visuals,
        mass_kg: mass(element, reporter)?,
    })
}

/// The mass of a link. Nothing here is moved by it, so that one which makes no sense counts as none.
fn mass(element: Element<'_, '_>, reporter: &mut Reporter<'_>) -> Result<Option<f64>, ReadError> {
    let mass = element
        .child("inertial")
        .and_then(|inertial| inertial.child("mass"));
    let Some(mass) = mass else { return Ok(None) };
    let text = mass.attribute("value", reporter)?;
    let number = text.and_then(|(text, _)| fast_float2::parse::<f64, _>(text.trim()).ok());
    Ok(number.filter(|mass| mass.is_finite()))
}

/// A `<visual>`, or `None` when its shape is of no kind that URDF has.
fn read_visual(
    element: Element<'_, '_>,
    materials: &Materials,
    reporter: &mut Reporter<'_>,
) -> Result<Option<UrdfVisual>, ReadError> {
    let name = element.attribute("name", reporter)?;
    let material = materials.of_visual(element, reporter)?;
    let shape = element
        .child("geometry")
        .and_then(|geometry| geometry.children().next());
    let Some(shape) = shape else {
        reporter.warn(WarningCode::UnknownShape, element.at(), || {
            "a visual has no shape; it is left out".into()
        });
        return Ok(None);
    };
    let Some(shape) = read_shape(shape, reporter)? else {
        return Ok(None);
    };
    Ok(Some(UrdfVisual {
        name: name.map(|(name, _)| name.into_owned()),
        origin: origin(element, reporter)?,
        shape,
        color: material.color,
        texture: material.texture,
    }))
}

fn read_shape(
    element: Element<'_, '_>,
    reporter: &mut Reporter<'_>,
) -> Result<Option<UrdfShape>, ReadError> {
    Ok(Some(match element.name() {
        "box" => {
            required(element, "size", reporter)?;
            let size: [f64; 3] = numbers(element, "size", reporter)?.unwrap_or_default();
            UrdfShape::Box {
                size: size.map(f64::abs),
            }
        }
        "cylinder" => UrdfShape::Cylinder {
            radius: length(element, "radius", reporter)?,
            length: length(element, "length", reporter)?,
        },
        "sphere" => UrdfShape::Sphere {
            radius: length(element, "radius", reporter)?,
        },
        "mesh" => UrdfShape::Mesh {
            filename: required(element, "filename", reporter)?.0.into_owned(),
            scale: numbers(element, "scale", reporter)?.unwrap_or([1.0; 3]),
        },
        other => {
            reporter.warn(WarningCode::UnknownShape, element.at(), || {
                let other = quote(other.as_bytes());
                format!("a visual's shape is {other}, which URDF does not have; it is left out")
            });
            return Ok(None);
        }
    }))
}
