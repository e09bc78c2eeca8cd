//! Blocks that the macro refuses while it is expanded.

#![allow(mixed_script_confusables)]

mod acceleration_inside;
mod both_forms;
mod broken_coordinate;
mod constraint_acceleration;
mod constraint_corner;
mod constraint_dependent;
mod constraint_everything;
mod constraint_immovable;
mod constraint_one_sided;
mod constraint_squared_velocity;
mod constraint_unit;
mod control_derivative;
mod declared_twice;
mod defined_by_itself;
mod derives;
mod dot_of_a_velocity;
mod dot_of_nothing;
mod force_on_no_coordinate;
mod implicit_multiplication;
mod index_out_of_range;
mod integrand_degree;
mod jerk;
mod last_semicolon;
mod lengths_differ;
mod limit_without_restitution;
mod middle_dot;
mod missing_semicolon;
mod no_coordinate;
mod no_kinetic_energy;
mod output_shape;
mod output_unit;
mod reaction_in_a_force;
mod redundant_coordinate;
mod redundant_member;
mod reserved_name;
mod reserved_prefix;
mod two_mistakes;
mod two_names_side_by_side;
mod unit_in_a_function;
mod unit_inferred;
mod unit_of_a_derivative;
mod unit_of_a_dissipation;
mod unit_of_a_force;
mod unit_of_a_maximum;
mod unit_of_a_power;
mod unit_of_a_sum;
mod unit_of_a_vector;
mod unit_of_an_argument;
mod unit_of_an_energy;
mod unit_of_time;
mod unknown_function;
mod unknown_name;
mod unknown_statement;
mod unknown_unit;
mod vector_for_scalar;
mod zero_pivot;

fn main() {}
