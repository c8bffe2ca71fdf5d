//! `--camera`: a camera of the scene by its name, a named view, or two angles.

use std::str::FromStr;

use posekit::keyframe::KeyedCamera;
use posekit_formats::scene::Scene;
use posekit_render::camera::{DEFAULT_VERTICAL_FOV_RAD, Projection, View};
use posekit_render::stage::CameraChoice;

use crate::failure::Failure;

/// Where the picture is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ViewArg {
    /// A named view.
    View(View),
    /// Degrees from the figure's front, and over the horizon.
    Around { yaw_deg: f32, pitch_deg: f32 },
}

impl FromStr for ViewArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let view = match text {
            "front" => View::Front,
            "back" => View::Back,
            "left" | "side" => View::Left,
            "right" => View::Right,
            "top" => View::Top,
            "three-quarter" => View::ThreeQuarter,
            _ => return angles(text),
        };
        Ok(Self::View(view))
    }
}

fn angles(text: &str) -> Result<ViewArg, String> {
    let refused = || {
        format!(
            "'{text}' is not a view; the views are front, back, left, right, side, top, three-quarter and YAW,PITCH in degrees"
        )
    };
    let (yaw, pitch) = text.split_once(',').ok_or_else(refused)?;
    let degrees = |digits: &str| {
        let value = digits.trim().parse::<f32>().ok();
        value.filter(|value| value.is_finite()).ok_or_else(refused)
    };
    let (yaw_deg, pitch_deg) = (degrees(yaw)?, degrees(pitch)?);
    if pitch_deg.abs() > 90.0 {
        return Err("the pitch must be from -90 to 90 degrees".to_owned());
    }
    Ok(ViewArg::Around { yaw_deg, pitch_deg })
}

impl Default for ViewArg {
    fn default() -> Self {
        Self::View(View::ThreeQuarter)
    }
}

impl ViewArg {
    fn choice(self) -> CameraChoice {
        match self {
            Self::View(view) => CameraChoice::View(view),
            Self::Around { yaw_deg, pitch_deg } => CameraChoice::Around {
                yaw_rad: (yaw_deg % 360.0).to_radians(),
                pitch_rad: pitch_deg.to_radians(),
                projection: Projection::Perspective {
                    vertical_fov_rad: DEFAULT_VERTICAL_FOV_RAD,
                },
            },
        }
    }
}

/// What the picture is taken with: a camera of the scene, or else a view around the figure.
#[derive(Clone, Debug)]
pub(super) enum Chosen {
    /// A camera of the scene file.
    OfScene(KeyedCamera),
    /// A view.
    View(CameraChoice),
}

/// What `--camera` stands for with this input: the scene's camera of that name, else a view. Without it,
/// the scene's first camera.
pub(super) fn choose(asked: Option<&str>, scene: Option<&Scene>) -> Result<Chosen, Failure> {
    let cameras = scene.map_or(&[][..], |scene| &scene.cameras);
    let Some(asked) = asked else {
        let first = cameras.first().map(|camera| camera.view.clone());
        let view = || Chosen::View(ViewArg::default().choice());
        return Ok(first.map_or_else(view, Chosen::OfScene));
    };
    if let Some(camera) = cameras.iter().find(|camera| camera.name == asked) {
        return Ok(Chosen::OfScene(camera.view.clone()));
    }
    let view = asked.parse::<ViewArg>().map_err(|refused| {
        let names: Vec<&str> = cameras.iter().map(|camera| camera.name.as_str()).collect();
        let failure = Failure::usage(format!("--camera: {refused}"));
        match names.as_slice() {
            [] => failure,
            names => failure.try_next(format!("the scene has {}", names.join(", "))),
        }
    })?;
    Ok(Chosen::View(view.choice()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_read_or_refused() {
        let view = |text: &str| text.parse::<ViewArg>();
        assert_eq!(view("side").unwrap(), ViewArg::View(View::Left));
        let around = ViewArg::Around {
            yaw_deg: -30.0,
            pitch_deg: 12.5,
        };
        assert_eq!(view("-30,12.5").unwrap(), around);
        for bad in ["sideways", "1,2,3", "nan,0", "0,91", ","] {
            assert!(view(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_scenes_cameras_go_before_views() {
        use posekit_formats::scene::{Camera, SkeletonSource};
        let camera = |name: &str, fov: f64| Camera {
            name: name.to_owned(),
            view: KeyedCamera {
                vertical_fov_deg: posekit::keyframe::Property::Fixed(fov),
                ..KeyedCamera::default()
            },
        };
        let mut scene = Scene::new(SkeletonSource::Inline(Vec::new()));
        scene.cameras = vec![camera("wide", 70.0), camera("front", 20.0)];
        let fov = |asked| match choose(asked, Some(&scene)).unwrap() {
            Chosen::OfScene(view) => Some(view.vertical_fov_deg.at(0.0)),
            Chosen::View(_) => None,
        };
        assert_eq!(fov(None), Some(70.0));
        assert_eq!(fov(Some("front")), Some(20.0));
        assert_eq!(fov(Some("top")), None);
        let refused = choose(Some("far"), Some(&scene)).unwrap_err();
        assert!(
            format!("{refused:?}").contains("wide, front"),
            "{refused:?}"
        );
        assert!(matches!(choose(None, None).unwrap(), Chosen::View(_)));
    }
}
