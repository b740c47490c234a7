"""Forward and inverse kinematics, Jacobian and the controller's CONFIG, all of pendant joints."""
