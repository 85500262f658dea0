"""The functions of CoppeliaSim that this package calls, with the first version of CoppeliaSim that has each."""

OLDEST = "4.6"  # the oldest version that is supported

# Versions before 4.0 count as 4.0.
CALLS = {
    "addScript": "4.0",
    "createForceSensor": "4.0",
    "createJoint": "4.0",
    "createPrimitiveShape": "4.3",
    "createProximitySensor": "4.0",
    "createShape": "4.5",
    "getFloatArrayProperty": "4.8",
    "getFloatProperty": "4.8",
    "getInt32Param": "4.2",
    "getJointMode": "4.0",
    "getJointPosition": "4.0",
    "getJointTargetForce": "4.3",
    "getJointType": "4.0",
    "getJointVelocity": "4.2",
    "getObject": "4.3",
    "getObjectAlias": "4.3",
    "getObjectFloatParam": "4.2",
    "getObjectInt32Param": "4.2",
    "getObjectMatrix": "4.0",
    "getObjectParent": "4.0",
    "getObjectType": "4.0",
    "getObjectVelocity": "4.0",
    "getObjectsInTree": "4.0",
    "getScript": "4.3",
    "getScriptStringParam": "4.3",
    "getShapeGeomInfo": "4.0",
    "getSimulationState": "4.0",
    "getSimulationTime": "4.0",
    "getSimulationTimeStep": "4.0",
    "handleProximitySensor": "4.0",
    "readCustomDataBlock": "4.0",
    "readCustomStringData": "4.7",
    "readProximitySensor": "4.0",
    "removeObjects": "4.3",
    "removeScript": "4.0",
    "setEngineFloatParam": "4.2",
    "setJointTargetForce": "4.3",
    "setJointTargetVelocity": "4.0",
    "setObjectAlias": "4.3",
    "setObjectInt32Param": "4.2",
    "setObjectMatrix": "4.0",
    "setObjectParent": "4.0",
    "setObjectSpecialProperty": "4.0",
    "setScriptStringParam": "4.3",
    "setShapeMass": "4.2",
    "setStepping": "4.6",
    "startSimulation": "4.0",
    "step": "4.6",
    "stopSimulation": "4.0",
    "writeCustomDataBlock": "4.0",
    "writeCustomStringData": "4.7",
}

# Where an older version lacks one, there is another way.
OPTIONAL = frozenset(
    {
        "getFloatArrayProperty",
        "getFloatProperty",
        "readCustomStringData",
        "writeCustomStringData",
    }
)
