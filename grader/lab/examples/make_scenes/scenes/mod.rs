//! The scenes themselves: all their numbers.
//!
//! Lengths are of the order of one to ten. The y axis points up; cameras look roughly along −z.

pub(crate) mod cornell;
mod cornell_glossy;
pub(crate) mod cornell_water;
mod furnace;
mod grazing;
mod lamp_room;
pub(crate) mod light_behind_wall;
mod many_lights;
pub(crate) mod mesh;
mod mirror_light;
mod mixed_lights;
mod planes;
mod sky;
pub(crate) mod veach_mis;

use crate::collection::Collection;

/// All public scenes.
pub(crate) fn all() -> Collection {
    let mut collection = Collection::default();
    cornell::add_to(&mut collection);
    cornell_water::add_to(&mut collection);
    cornell_glossy::add_to(&mut collection);
    veach_mis::add_to(&mut collection);
    many_lights::add_to(&mut collection);
    mirror_light::add_to(&mut collection);
    light_behind_wall::add_to(&mut collection);
    mixed_lights::add_to(&mut collection);
    mesh::add_to(&mut collection);
    grazing::add_to(&mut collection);
    lamp_room::add_to(&mut collection);
    furnace::add_to(&mut collection);
    planes::add_to(&mut collection);
    sky::add_to(&mut collection);
    collection
}
